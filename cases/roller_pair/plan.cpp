// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/roller_pair/plan.hpp"

#include "cases/work/machine_speed.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    constexpr double tried_grids = 3; // until a grid fits the contact, as a rule

    double unknowns(const RollerPairCase &input)
    {
      return 0.5 * input.grid.across * input.grid.along;
    }
  } // namespace

  double operations(const RollerPairCase &input)
  {
    return tried_grids * std::pow(unknowns(input), 3) / 3 * static_cast<double>(input.forces.size());
  }

  double bytes_needed(const RollerPairCase &input)
  {
    const double at_once = std::min<double>(available_threads(), static_cast<double>(input.forces.size()));
    return 0.04e9 +
           at_once * 3 * 8 * unknowns(input) * unknowns(input); // a compliance, its scaled copy, a factor
  }

  std::string plan_report(const RollerPairCase &input)
  {
    const double workers = std::min<double>(available_threads(), static_cast<double>(input.forces.size()));
    return fmt::format("Will be computed\n  {} of {} by {} cells, on grids that follow the "
                       "contact\n{}Left out\n  finite elements, there "
                       "are none in this scene; one half of the cells, which is as the other one turned by "
                       "half a turn\nExpected: {:.3g} "
                       "operations, {} s on this machine by 1 process of {}; {} GB\n",
                       counted(input.forces.size(), "contact"), input.grid.across, input.grid.along,
                       input.rollers.free_ends ? "  what the free ends of both rollers add, by waves along "
                                                 "the edges of quarter-spaces\n"
                                               : "",
                       operations(input),
                       two_digits(operations(input) / operations_a_second() / std::max(1.0, workers)),
                       counted(available_threads(), "thread"), two_digits(1e-9 * bytes_needed(input)));
  }
} // namespace flank
