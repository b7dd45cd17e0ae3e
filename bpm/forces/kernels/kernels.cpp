// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled three times, with BOBA_KERNEL_TABLE naming the table and the compiler's flags the instruction set.
#include "bpm/forces/kernels/kernels.h"

#include "bpm/forces/kernels/bond_kernel.h"
#include "bpm/forces/kernels/contact_kernel.h"
#include "bpm/forces/kernels/drift_kernel.h"
#include "bpm/forces/kernels/frame_kernel.h"
#include "bpm/forces/kernels/near_kernel.h"
#include "bpm/forces/kernels/point_kernel.h"

#define BOBA_STRINGIFY_(x) #x
#define BOBA_STRINGIFY(x) BOBA_STRINGIFY_(x)

namespace boba::kernels {

namespace {

template <class Coordinate, class Real, class Law>
constexpr RememberingKernels<Coordinate, Real, Law> remembering = {&volumes_of_whole_bonds<Coordinate, Real, Law>,
                                                                   &bond_forces<Coordinate, Real, Law>,
                                                                   &bond_forces_from_before<Coordinate, Real, Law>};

} // namespace

extern const KernelTable BOBA_KERNEL_TABLE = {
    BOBA_STRINGIFY(BOBA_KERNEL_ISA),
    {&volumes_of_nodes<double, double>, &bond_forces<double, double, BondLaw>,
     &bond_forces_from_before<double, double, BondLaw>, remembering<double, double, BreakingBondLaw>,
     remembering<double, double, YieldingBondLaw>, &drift_block<double, double>, &collect_nodes<double, double>,
     &add_touches<double>, &fit_frames<double>, &frame_residuals<double>},
    {&volumes_of_nodes<std::int32_t, float>, &bond_forces<std::int32_t, float, BondLaw>,
     &bond_forces_from_before<std::int32_t, float, BondLaw>, remembering<std::int32_t, float, BreakingBondLaw>,
     remembering<std::int32_t, float, YieldingBondLaw>, &drift_block<std::int32_t, float>,
     &collect_nodes<std::int32_t, float>, &add_touches<float>, &fit_frames<std::int32_t>,
     &frame_residuals<std::int32_t>},
    &near_candidates,
    &contact_forces<ContactLaw>,
    &contact_forces<HertzLaw>,
    &point_contact_forces<ContactLaw>,
    &point_contact_forces<HertzLaw>,
    &near_places};

} // namespace boba::kernels
