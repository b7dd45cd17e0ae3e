// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// One binary for all machines: a function marked so is compiled for these instruction sets and chosen at start.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) &&               \
    !defined(__SANITIZE_THREAD__)
#define BOBA_VECTOR_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define BOBA_VECTOR_CLONES
#endif
