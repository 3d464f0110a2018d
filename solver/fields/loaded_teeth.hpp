// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "solver/elements/body_elements.hpp"
#include "solver/reduction/tooth_responses.hpp"

namespace flank
{
  /// Displacements inside a body under loads on its flanks, tooth sector by tooth sector: the cuts as the reduction closes them, the inside
  /// by one factorisation of a sector that serves all teeth and loads.
  class LoadedTeeth
  {
  public:
    /// Condenses one sector and factors its inside. `elements` is kept by reference. Throws ComputationError.
    LoadedTeeth(const BodyElements &elements, const BodyModel &model);
    ~LoadedTeeth();

    /// Of all nodes of the wanted teeth's sectors, in each tooth's own axes: [load case][wanted tooth], ElasticBody's unknowns. [mm]
    std::vector<std::vector<Eigen::VectorXd>> displacements(const std::vector<TeethLoads> &loads, const std::vector<int> &wanted) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
  };
} // namespace flank
