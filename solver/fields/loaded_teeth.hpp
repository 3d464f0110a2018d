// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "solver/elements/body_elements.hpp"
#include "solver/reduction/tooth_responses.hpp"

#include <memory>

namespace flank
{
  /// Displacements inside a body under loads on its flanks, tooth sector by tooth sector: the cuts as the
  /// reduction closes them, the inside by one factorisation of a sector that serves all teeth and loads.
  class LoadedTeeth
  {
  public:
    /// Condenses one sector and factors its inside. `elements` is kept by reference. Throws ComputationError.
    LoadedTeeth(const BodyElements &elements, const BodyModel &model);
    ~LoadedTeeth();

    /// Displacements of the cuts of the wanted teeth, for each load case; one factorisation a harmonic or
    /// segment serves all cases.
    CutDisplacements cuts(const std::vector<TeethLoads> &loads, const std::vector<int> &wanted) const;

    /// Displacements of all nodes of one tooth's sector in its own axes, in the order of ElasticBody's
    /// unknowns. [mm] Not for several threads at once.
    Eigen::VectorXd displacement(const TeethLoads &loads, int tooth, const CutDisplacement &cut) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
  };
} // namespace flank
