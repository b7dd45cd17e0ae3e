// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/hdf5/hdf5_file.h"
#include "bpm/packing/snapshot.h"

namespace boba::trajectory {

/// What a trajectory holds once: nodes, grains, bonds, undeformed templates; every length, index and value is checked.
///
/// Grains have one node or more and follow each other; grains of one template have the same number of nodes and the
/// same bonds; a bond joins two nodes of one grain; undeformed nodes have their bonds at rest.
/// \throws InputError with the file, the dataset, the value and what is allowed.
Topology read_topology(const hdf5::File& file);

} // namespace boba::trajectory
