// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/position_record.hpp"

namespace flank
{
  namespace
  {
    /// Calls use(member) for every plain member, in one order for both ways.
    template <class Result, class Use>
    void each_plain(Result &r, const Use &use)
    {
      use(r.torque), use(r.phase), use(r.theta), use(r.stiffness), use(r.gear_torque), use(r.max_pressure), use(r.edge_pressure);
      use(r.max_pressure_roll), use(r.max_pressure_z), use(r.shuttling_moment), use(r.load_centre), use(r.max_line_load);
      for (int axis = 0; axis < 4; ++axis)
        use(r.tilt[axis]);
      use(r.certificate), use(r.asymmetry), use(r.subsurface), use(r.cells), use(r.pivots), use(r.grids);
    }
  } // namespace

  void pack(const std::vector<PositionResult> &band, Packer &out)
  {
    static const std::vector<GridCell> none;
    out.value(static_cast<int>(band.size()));
    out.values(band.empty() || !band.front().grid_cells ? none : *band.front().grid_cells);
    for (const PositionResult &result : band)
      {
        each_plain(result, [&](const auto &value) { out.value(value); });
        out.values(result.pairs);
        out.values(result.lines);
        out.values(result.cell_forces);
      }
  }

  std::vector<PositionResult> unpack_band(Unpacker &in)
  {
    std::vector<PositionResult> band(in.value<int>());
    auto                        cells = std::make_shared<const std::vector<GridCell>>(in.values<GridCell>());
    for (PositionResult &result : band)
      {
        each_plain(result, [&](auto &value) { value = in.value<std::decay_t<decltype(value)>>(); });
        result.pairs       = in.values<PairLoad>();
        result.lines       = in.values<LineLoad>();
        result.cell_forces = in.values<double>();
        if (!cells->empty())
          result.grid_cells = cells;
      }
    return band;
  }
} // namespace flank
