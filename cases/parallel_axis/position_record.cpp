// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/position_record.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    /// Calls use(member) for every plain member, in one order for both ways.
    template <class Result, class Use>
    void each_plain(Result &r, const Use &use)
    {
      use(r.torque), use(r.phase), use(r.theta), use(r.stiffness), use(r.gear_torque), use(r.max_pressure),
          use(r.edge_pressure);
      use(r.max_pressure_roll), use(r.max_pressure_z), use(r.shuttling_moment), use(r.load_centre),
          use(r.max_line_load);
      for (int axis = 0; axis < 4; ++axis)
        use(r.tilt[axis]);
      use(r.certificate), use(r.asymmetry), use(r.subsurface), use(r.cells), use(r.pivots), use(r.grids);
    }

    /// Whether all its numbers are, and its cells lie where cells can.
    bool is_finite(const PositionResult &r)
    {
      bool       finite = r.tilt.allFinite();
      const auto check  = [&](const auto... values) { finite = finite && (std::isfinite(values) && ...); };
      check(r.theta, r.stiffness, r.gear_torque, r.max_pressure, r.edge_pressure, r.max_pressure_roll,
            r.max_pressure_z);
      check(r.shuttling_moment, r.load_centre, r.max_line_load, r.asymmetry);
      check(r.subsurface.shear, r.subsurface.shear_depth, r.subsurface.von_mises,
            r.subsurface.von_mises_depth);
      for (const PairLoad &load : r.pairs)
        check(load.force, load.max_pressure);
      for (const LineLoad &load : r.lines)
        check(load.z, load.pinion_roll, load.load_per_length, load.max_pressure, load.half_width);
      for (const double force : r.cell_forces)
        check(force);
      if (r.grid_cells)
        for (const GridCell &cell : *r.grid_cells)
          {
            check(cell.z, cell.pinion_roll, cell.gear_roll, cell.area, cell.gap);
            const auto place = static_cast<int>(cell.place);
            finite           = finite && place >= 0 && place <= static_cast<int>(CellPlace::corner);
          }
      return finite;
    }
  } // namespace

  void pack(const std::vector<PositionResult> &band, Packer &out)
  {
    std::vector<GridCells> grids; // most torques of a band share theirs
    const auto             number = [&](const GridCells &cells) {
      return cells ? static_cast<int>(std::find(grids.begin(), grids.end(), cells) - grids.begin()) : -1;
    };
    for (const PositionResult &result : band)
      if (number(result.grid_cells) == static_cast<int>(grids.size()))
        grids.push_back(result.grid_cells);
    out.value(static_cast<std::int64_t>(grids.size()));
    for (const GridCells &cells : grids)
      out.values(*cells);
    out.value(static_cast<std::int64_t>(band.size()));
    for (const PositionResult &result : band)
      {
        each_plain(result, [&](const auto &value) { out.value(value); });
        out.values(result.pairs);
        out.values(result.lines);
        out.value(number(result.grid_cells));
        out.values(result.cell_forces);
      }
  }

  std::vector<PositionResult> unpack_band(Unpacker &in)
  {
    constexpr std::size_t  least_bytes = 200; // of a result
    std::vector<GridCells> grids(in.count(sizeof(std::int64_t)));
    for (GridCells &cells : grids)
      cells = std::make_shared<const std::vector<GridCell>>(in.values<GridCell>());
    std::vector<PositionResult> band(in.count(least_bytes));
    for (PositionResult &result : band)
      {
        each_plain(result, [&](auto &value) { value = in.value<std::decay_t<decltype(value)>>(); });
        result.pairs      = in.values<PairLoad>();
        result.lines      = in.values<LineLoad>();
        const auto number = in.value<int>();
        if (number < -1 || number >= static_cast<int>(grids.size()))
          throw UnusableRecord("a grid that is not there");
        result.cell_forces = in.values<double>();
        if (number >= 0)
          result.grid_cells = grids[static_cast<std::size_t>(number)];
      }
    return band;
  }

  bool is_band(const std::vector<char> &bytes, const std::vector<double> &torques, const double phase,
               const int cycles)
  try
    {
      Unpacker in(bytes);
      for (int cycle = 0; cycle < cycles; ++cycle)
        {
          const std::vector<PositionResult> band = unpack_band(in);
          if (band.size() != torques.size())
            return false;
          for (std::size_t t = 0; t < band.size(); ++t)
            {
              const PositionResult &r = band[t];
              if (!is_finite(r) || !r.certificate.holds() || r.cells < 0 || r.torque != torques[t] ||
                  r.phase != phase + cycle ||
                  r.cell_forces.size() != (r.grid_cells ? r.grid_cells->size() : 0))
                return false;
            }
        }
      return in.at_end();
    }
  catch (const UnusableRecord &)
    {
      return false;
    }
} // namespace flank
