// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/laws/material.h"
#include "bpm/laws/plain_laws.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace boba {

/// A contact law with its constants and the kernel made for it: chosen once, when a force field is made.
class ContactModel : public PlainContact {
public:
  /// The contact pass, see kernels::ContactKernel.
  virtual std::int64_t evaluate(const kernels::ContactCandidates& candidates, kernels::ContactNode* rows,
                                kernels::Touch* touches, kernels::ContactSums& sums) const = 0;
  /// The same for grains of one node, see kernels::PointContactKernel.
  virtual void evaluate(const kernels::PointCandidates& candidates, const kernels::PointSumming& how,
                        const kernels::PointScratch& scratch, kernels::PointSums* sums) const = 0;
};

/// The model of a law. Source: the law's own file.
template <class Law> class ContactModelOf final : public PlainContactOf<Law, ContactModel> {
public:
  ContactModelOf(const Law& law, kernels::ContactKernel<Law> kernel, kernels::PointContactKernel<Law> point_kernel)
      : PlainContactOf<Law, ContactModel>(law), kernel_(kernel), point_kernel_(point_kernel) {}
  std::int64_t evaluate(const kernels::ContactCandidates& candidates, kernels::ContactNode* rows,
                        kernels::Touch* touches, kernels::ContactSums& sums) const override {
    return kernel_(candidates, this->law(), rows, touches, sums);
  }
  void evaluate(const kernels::PointCandidates& candidates, const kernels::PointSumming& how,
                const kernels::PointScratch& scratch, kernels::PointSums* sums) const override {
    point_kernel_(candidates, this->law(), how, scratch, sums);
  }

private:
  kernels::ContactKernel<Law> kernel_;
  kernels::PointContactKernel<Law> point_kernel_;
};

/// A contact law that scenes may choose by name.
struct ContactLawEntry {
  std::string name;                  ///< of `[material] contact = "..."`
  std::vector<Parameter> parameters; ///< keys of the table that are the law's own
  bool for_spheres = false;          ///< for grains of one node only
  /// The law with a material's constants; Material::contact_parameters holds a value for each of `parameters`.
  std::function<std::shared_ptr<const ContactModel>(const Material&)> make;
};

/// All laws there are: "hookean" (laws/contact.h) first, "hertz" (laws/hertz.h), then those that were added.
const std::vector<ContactLawEntry>& contact_laws();

/// Adds a law, before the first scene is read; see outside_contact_law.h. One thread only.
/// \throws std::invalid_argument when the name or a parameter's name is taken.
void add_contact_law(ContactLawEntry entry);

/// The law that a material names.
/// \throws std::invalid_argument when there is none of that name, or when values of its parameters are missing.
const ContactLawEntry& contact_law_of(const Material& material);
std::shared_ptr<const ContactModel> contact_model(const Material& material);

} // namespace boba
