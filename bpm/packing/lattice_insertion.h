// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/insertion.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace boba {

/// Where grains are placed: at random, or on the sites of a crystal.
enum class Arrangement { random, fcc, hcp, bcc, sc };

/// "random", "fcc", "hcp", "bcc", "sc", in the order of the numbers.
std::vector<std::string> arrangement_names();
std::string name_of(Arrangement arrangement);
/// \throws std::invalid_argument for another name.
Arrangement arrangement_named(const std::string& name);

/// Repetitions of the conventional cell along x, y, z that hold `count` grains; nothing when none do.
///
/// fcc (4 grains), bcc (2) and sc (1): n x n x n cubic cells. hcp (4 grains): the orthogonal cell a x sqrt(3) a x
/// sqrt(8/3) a, the numbers for which the whole is nearest to a cube, at most 1.3 times as long as it is short.
std::optional<std::array<int, 3>> lattice_repetitions(Arrangement arrangement, std::int64_t count);

/// \throws std::invalid_argument when `count` grains do not fill the lattice; names the next counts that do.
void check_lattice_count(Arrangement arrangement, std::int64_t count);

/// Grains at rest at random angles on the sites of a crystal, in the periodic cell that fits it: the cubic axes of fcc,
/// bcc and sc along x, y, z; of hcp the close-packed rows along x and the hexagonal axis along z. Grains of several
/// species are dealt out to the sites at random.
/// \throws std::invalid_argument for a count that does not fill the lattice, and when neighbours' bounding spheres
/// would overlap, with the packing fraction that is allowed.
Packing insert_on_lattice(const Insertion& insertion, Arrangement arrangement);

} // namespace boba
