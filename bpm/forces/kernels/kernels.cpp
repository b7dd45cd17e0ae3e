// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled three times, with BOBA_KERNEL_TABLE naming the table and the compiler's flags the instruction set.
#include "bpm/forces/kernels/kernels.h"

#include "bpm/forces/kernels/bond_kernel.h"
#include "bpm/forces/kernels/contact_kernel.h"
#include "bpm/forces/kernels/drift_kernel.h"
#include "bpm/forces/kernels/frame_kernel.h"
#include "bpm/forces/kernels/near_kernel.h"

#define BOBA_STRINGIFY_(x) #x
#define BOBA_STRINGIFY(x) BOBA_STRINGIFY_(x)

namespace boba::kernels {

extern const KernelTable BOBA_KERNEL_TABLE = {
    BOBA_STRINGIFY(BOBA_KERNEL_ISA), native_lanes,   &volumes_of_nodes, &bond_forces,     &drift_block, &collect_nodes,
    &contact_forces,                 &add_touches,   &fit_frames,       &frame_residuals, &near_places};

} // namespace boba::kernels
