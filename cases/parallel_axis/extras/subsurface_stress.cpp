// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/extra_kind.hpp"
#include "cases/parallel_axis/pair/conventions.hpp"
#include "mesh/base/units.hpp"

#include <limits>

namespace flank
{
  namespace
  {
    /// Greatest shear and von Mises stress below the greatest pressure inside the flanks. The positions keep
    /// it: they are solved with it.
    class SubsurfaceStressOfPositions : public Extra
    {
    public:
      std::string name() const override { return "sub-surface stress"; }

      void keep(const ParallelAxisCase &, Kept &kept) const override { kept.subsurface_stress = true; }

      ExtraPlan plan(const ParallelAxisCase &) const override
      {
        return { { "greatest shear and von Mises stress below the greatest pressure of every solution" },
                 {} };
      }

      ExtraOutput compute(const FinishedRun &run) const override
      {
        if (run.work.rank() != 0)
          return {};
        ResultTable table("subsurface",
                          std::string(conventions) +
                              "# below the greatest pressure inside the flanks, half-space under the actual "
                              "pressures; depths from the surface\n",
                          { torque_column(),
                            position_column(),
                            phase_column(),
                            { "max_pressure_MPa", "MPa", "{:.4f}" },
                            { "shear_MPa", "MPa", "{:.4f}" },
                            { "shear_depth_um", "um", "{:.4f}" },
                            { "von_mises_MPa", "MPa", "{:.4f}" },
                            { "von_mises_depth_um", "um", "{:.4f}" } });
        constexpr double none = std::numeric_limits<double>::quiet_NaN(); // loaded at edges alone
        for (std::size_t t = 0; t < run.at.size(); ++t)
          for (std::size_t k = 0; run.input.torques[t] > 0 && k < run.at[t].size(); ++k)
            {
              const PositionResult &p = run.at[t][k];
              const auto &below = p.subsurface;
              const bool found = below.shear > 0;
              table.add({ run.input.torques[t] / units::newton_metre, static_cast<double>(k), p.phase,
                          p.max_pressure, found ? below.shear : none,
                          found ? below.shear_depth / units::micrometre : none,
                          found ? below.von_mises : none,
                          found ? below.von_mises_depth / units::micrometre : none });
            }
        return { .summary = {}, .table = std::move(table), .patterns = {} };
      }
    };
  } // namespace

  ExtraKind subsurface_stress()
  {
    return on_request(
        "output.subsurface_stress",
        "greatest shear and von Mises stress below the greatest pressure inside the flanks, and their depths",
        "subsurface.csv", "stress below the greatest pressure",
        [](const CaseFile &, const ParallelAxisCase &) {
          return std::make_shared<SubsurfaceStressOfPositions>();
        });
  }
} // namespace flank
