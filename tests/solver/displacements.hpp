// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "solver/fields/loaded_teeth.hpp"

/// LoadedTeeth::displacement() of several teeth under one load case. [mm]
inline std::vector<Eigen::VectorXd> displacements(const flank::LoadedTeeth &body,
                                                  const flank::TeethLoads &loads,
                                                  const std::vector<int> &wanted)
{
  const auto cuts = body.cuts({ loads }, wanted).front();
  std::vector<Eigen::VectorXd> result;
  for (const int tooth : wanted)
    result.push_back(body.displacement(loads, tooth, cuts.at(tooth)));
  return result;
}
