// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/linear/direct_solver.hpp"

#include "solver/libraries/element_libraries.hpp"

namespace flank
{
  Condensation condense(const StiffnessMatrix &stiffness, const std::vector<char> &fixed,
                        const std::vector<int> &kept, const bool keep_inside)
  {
    return element_libraries().condense(stiffness, fixed, kept, keep_inside);
  }

  std::unique_ptr<const DirectSolver> make_direct_solver(const StiffnessMatrix &stiffness,
                                                         const std::vector<char> &fixed)
  {
    return condense(stiffness, fixed, {}, true).inside;
  }
} // namespace flank
