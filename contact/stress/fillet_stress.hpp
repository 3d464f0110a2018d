// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "solver/elements/body_elements.hpp"

#include <array>
#include <vector>

namespace flank
{
  /// Greatest principal stress over the arc of a sector's two fillets [MPa] under nodal displacements [mm] in
  /// the tooth's axes: [side][node along the face]. Where elements meet their values are averaged. A
  /// polynomial of the arc of degree 4 is then fitted to them: towards the middle of a fillet, where elements
  /// of the tooth and of the rim meet at a slant, the tooth's say too much and the rim's too little.
  std::array<std::vector<double>, 2> fillet_stress(const BodyElements &elements,
                                                   const Eigen::VectorXd &displacement);
} // namespace flank
