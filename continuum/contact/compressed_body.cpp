// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/contact/compressed_body.h"

namespace boba::continuum {

void check(const CompressedBody& body) {
  check_positive("radius", body.radius);
  check(body.material);
  check(body.interface);
}

} // namespace boba::continuum
