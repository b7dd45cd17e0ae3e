// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// A function of a law. It is always compiled into its caller: the kernels are compiled once for each instruction set,
/// and a copy of its own, made for the widest one, could otherwise be linked into code for any machine.
#define BOBA_LAW_FUNCTION [[gnu::always_inline]] constexpr
