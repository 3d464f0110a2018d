// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/extra_kind.hpp"

#include "mesh/base/counted.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace flank
{
  namespace
  {
    constexpr double share = 0.01; ///< of the torques
    const char *const light_load_pattern_name = "contact at 1 % of the load";

    std::vector<double> light_torques(const ParallelAxisCase &input)
    {
      std::vector<double> light = input.torques;
      for (double &torque : light)
        torque *= share;
      return light;
    }

    int grids_of(const ParallelAxisCase &input)
    {
      return static_cast<int>(torque_bands(input.pair, light_torques(input)).size());
    }

    class LightLoadPattern : public Extra
    {
    public:
      std::string name() const override { return light_load_pattern_name; }

      ExtraPlan plan(const ParallelAxisCase &input) const override
      {
        return { .computed = { "contact pattern at 1 % of the load: " +
                               counted(input.positions * grids_of(input), "more grid") },
                 .left_out = {} };
      }

      ExtraCost cost(const ParallelAxisCase &input, int) const override
      {
        return { .grids = grids_of(input) };
      }

      ExtraOutput compute(const FinishedRun &run) const override
      {
        const ParallelAxisCase &input = run.input;
        const std::vector<double> light = light_torques(input);
        const auto at =
            roll(loaded_pair(input, run.bodies.bodies()), light, input.positions, 1, name(), run.work);
        const auto failures = failures_of(at, run.work);
        for (const auto &[t, why] : failures)
          spdlog::warn("no contact pattern at 1 % of {:.6g} N m: {}", input.torques[t] / units::newton_metre,
                       why);
        ExtraOutput out;
        if (run.work.rank() == 0)
          for (std::size_t t = 0; t < light.size(); ++t)
            if (light[t] > 0 && !failures.contains(t))
              out.patterns.push_back({ static_cast<int>(t), share, "contact_pattern_at_1_percent",
                                       contact_pattern(input.pair, at[t], input.grid.slices) });
        return out;
      }
    };
  } // namespace

  ExtraKind light_load_pattern()
  {
    ExtraKind kind = on_request(
        light_load_pattern_name, "output.light_load_pattern",
        "the contact pattern at 1 % of every torque too", "", "contact pattern at 1 % of the load",
        [](const CaseFile &, const ParallelAxisCase &) { return std::make_shared<LightLoadPattern>(); });
    kind.in_studies = false;
    kind.of_loaded_teeth = "output.light_load_pattern";
    return kind;
  }
} // namespace flank
