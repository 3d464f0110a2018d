// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/extras/extra_kind.hpp"
#include "cases/parallel_axis/extras/free_edges.hpp"
#include "cases/parallel_axis/pair/conventions.hpp"
#include "mesh/base/units.hpp"

#include <limits>
#include <memory>

namespace flank
{
  namespace
  {
    const char *const sub_surface_stress_name = "sub-surface stress";

    /// Shear, its depth, von Mises, its depth [MPa, mm].
    std::vector<double> below(const GearPair &pair, const EdgesOfPair *edges,
                              const std::vector<ContactCell> &cells, const Eigen::VectorXd &force,
                              const Eigen::VectorXd &pressure)
    {
      const half_space::SubsurfaceStress found = below_greatest_pressure(pair, edges, cells, force, pressure);
      return { found.shear, found.shear_depth, found.von_mises, found.von_mises_depth };
    }

    /// Greatest shear and von Mises stress below the greatest pressure that has a limit, found when a
    /// position is solved.
    class SubsurfaceStressOfPositions : public Extra
    {
    public:
      std::string name() const override { return sub_surface_stress_name; }

      void keep(const ParallelAxisCase &input, Kept &kept) const override
      {
        kept.measures[name()] = [edges = free_edges_of(input)](const GearPair &pair, const auto &cells,
                                                               const auto &force, const auto &pressure) {
          return below(pair, edges.get(), cells, force, pressure);
        };
      }

      ExtraPlan plan(const ParallelAxisCase &) const override
      {
        return { .computed = { "greatest shear and von Mises stress below the greatest pressure of every "
                               "solution" },
                 .left_out = {} };
      }

      ExtraOutput compute(const FinishedRun &run) const override
      {
        if (run.work.rank() != 0)
          return {};
        ResultTable table(
            "subsurface",
            std::string(conventions) +
                "# below the greatest pressure that has a limit, half-space (near free ends: elastic "
                "wedge) under the pressures of its cells; depths from the surface\n",
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
              const std::vector<double> stress = measured(p, name());
              const bool found = stress.at(0) > 0;
              table.add({ run.input.torques[t] / units::newton_metre, static_cast<double>(k), p.phase,
                          p.max_pressure, found ? stress.at(0) : none,
                          found ? stress.at(1) / units::micrometre : none, found ? stress.at(2) : none,
                          found ? stress.at(3) / units::micrometre : none });
            }
        return { .summary = {}, .table = std::move(table), .patterns = {} };
      }
    };
  } // namespace

  ExtraKind subsurface_stress()
  {
    ExtraKind kind = on_request(
        sub_surface_stress_name, "output.subsurface_stress",
        "greatest shear and von Mises stress below the greatest pressure that has a limit, and their depths",
        "subsurface.csv", "stress below the greatest pressure",
        [](const CaseFile &, const ParallelAxisCase &) {
          return std::make_shared<SubsurfaceStressOfPositions>();
        });
    kind.of_loaded_teeth = "output.subsurface_stress";
    return kind;
  }
} // namespace flank
