// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/pair/position_record.hpp"

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
      use(r.certificate), use(r.asymmetry), use(r.condition), use(r.subsurface), use(r.cells), use(r.pivots),
          use(r.grids);
    }

    bool is_place(const CellPlace place)
    {
      return static_cast<int>(place) >= 0 && place <= CellPlace::corner;
    }

    /// Calls use(member) for every plain member of a contact cell, in one order for both ways.
    template <class Cell, class Use>
    void each_plain_of_cell(Cell &c, const Use &use)
    {
      use(c.slice), use(c.area), use(c.gap), use(c.lever), use(c.place);
      for (int axis = 0; axis < 4; ++axis)
        use(c.tilt[axis]);
      for (auto *patch : { &c.pinion, &c.gear })
        {
          use(patch->tooth), use(patch->roll), use(patch->z);
          use(patch->half_profile), use(patch->half_generator);
        }
    }

    void pack(const std::vector<ContactCell> &cells, Packer &out)
    {
      out.value(static_cast<std::int64_t>(cells.size()));
      for (const ContactCell &cell : cells)
        {
          each_plain_of_cell(cell, [&](const auto &value) { out.value(value); });
          out.value(static_cast<unsigned char>(cell.window_border));
          for (const Patch *patch : { &cell.pinion, &cell.gear })
            {
              std::vector<double> outline;
              for (const Eigen::Vector2d &corner : patch->outline)
                outline.insert(outline.end(), { corner.x(), corner.y() });
              out.values(outline);
            }
        }
    }

    std::vector<ContactCell> unpack_cells(Unpacker &in)
    {
      constexpr std::size_t least_bytes = 100; // of a cell
      std::vector<ContactCell> cells(in.count(least_bytes));
      for (ContactCell &cell : cells)
        {
          each_plain_of_cell(cell, [&](auto &value) { value = in.value<std::decay_t<decltype(value)>>(); });
          cell.window_border = in.value<unsigned char>() != 0;
          for (Patch *patch : { &cell.pinion, &cell.gear })
            {
              const auto outline = in.values<double>();
              for (std::size_t k = 0; k + 1 < outline.size(); k += 2)
                patch->outline.push_back({ outline[k], outline[k + 1] });
            }
        }
      return cells;
    }

    Eigen::VectorXd unpack_vector(Unpacker &in)
    {
      const auto values = in.values<double>();
      return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
    }

    /// Whether the numbers of kept cells are, and there is a force and a gap a cell.
    bool is_finite(const std::vector<ContactCell> &cells, const PositionResult &r)
    {
      const auto n = static_cast<Eigen::Index>(cells.size());
      bool finite = r.contact_force.size() == n && r.contact_gap.size() == n && r.contact_force.allFinite() &&
                    r.contact_gap.allFinite();
      for (const ContactCell &cell : cells)
        {
          finite = finite && is_place(cell.place) && cell.area > 0;
          each_plain_of_cell(cell, [&](const auto &value) {
            if constexpr (std::is_floating_point_v<std::decay_t<decltype(value)>>)
              finite = finite && std::isfinite(value);
          });
          for (const Patch *patch : { &cell.pinion, &cell.gear })
            for (const Eigen::Vector2d &corner : patch->outline)
              finite = finite && corner.allFinite();
        }
      return finite;
    }

    /// Whether all its numbers are, and its cells lie where cells can.
    bool is_finite(const PositionResult &r)
    {
      bool finite = r.tilt.allFinite() && r.condition >= 0; // infinite where loaded cells coincide
      const auto check = [&](const auto... values) { finite = finite && (std::isfinite(values) && ...); };
      check(r.theta, r.stiffness, r.gear_torque, r.max_pressure, r.edge_pressure, r.max_pressure_roll,
            r.max_pressure_z);
      check(r.shuttling_moment, r.load_centre, r.max_line_load, r.asymmetry);
      check(r.subsurface.shear, r.subsurface.shear_depth, r.subsurface.von_mises,
            r.subsurface.von_mises_depth);
      for (const PairLoad &load : r.pairs)
        check(load.force, load.max_pressure);
      for (const LineLoad &load : r.lines)
        check(load.z, load.pinion_roll, load.load_per_length, load.max_pressure, load.half_width,
              load.height);
      for (const double force : r.cell_forces)
        check(force);
      if (r.grid_cells)
        for (const GridCell &cell : *r.grid_cells)
          {
            check(cell.z, cell.pinion_roll, cell.gear_roll, cell.area, cell.gap);
            finite = finite && is_place(cell.place);
          }
      return finite && (!r.contact_cells || is_finite(*r.contact_cells, r));
    }

    /// Number of a list of cells that several torques of a band share, the first time after all others; -1:
    /// none.
    template <class Cells>
    int number_in(std::vector<Cells> &lists, const Cells &cells)
    {
      if (!cells)
        return -1;
      const auto at = std::find(lists.begin(), lists.end(), cells);
      if (at == lists.end())
        return lists.push_back(cells), static_cast<int>(lists.size()) - 1;
      return static_cast<int>(at - lists.begin());
    }

    /// What a band's torques share, by the number that the record has.
    template <class Cells>
    Cells of_number(const std::vector<Cells> &lists, const int number)
    {
      if (number < -1 || number >= static_cast<int>(lists.size()))
        throw UnusableRecord("a grid that is not there");
      return number < 0 ? nullptr : lists[static_cast<std::size_t>(number)];
    }
  } // namespace

  void pack(const std::vector<PositionResult> &band, Packer &out)
  {
    std::vector<GridCells> grids; // most torques of a band share theirs
    std::vector<ContactCells> kept;
    for (const PositionResult &result : band)
      number_in(grids, result.grid_cells), number_in(kept, result.contact_cells);
    out.value(static_cast<std::int64_t>(grids.size()));
    for (const GridCells &cells : grids)
      out.values(*cells);
    out.value(static_cast<std::int64_t>(kept.size()));
    for (const ContactCells &cells : kept)
      pack(*cells, out);
    out.value(static_cast<std::int64_t>(band.size()));
    for (const PositionResult &result : band)
      {
        each_plain(result, [&](const auto &value) { out.value(value); });
        out.values(result.pairs);
        out.values(result.lines);
        out.values(std::vector<char>(result.failure.begin(), result.failure.end()));
        out.value(number_in(grids, result.grid_cells));
        out.values(result.cell_forces);
        out.value(number_in(kept, result.contact_cells));
        if (result.contact_cells)
          for (const Eigen::VectorXd *values : { &result.contact_force, &result.contact_gap })
            out.values(std::vector<double>(values->begin(), values->end()));
      }
  }

  std::vector<PositionResult> unpack_band(Unpacker &in)
  {
    constexpr std::size_t least_bytes = 200; // of a result
    std::vector<GridCells> grids(in.count(sizeof(std::int64_t)));
    for (GridCells &cells : grids)
      cells = std::make_shared<const std::vector<GridCell>>(in.values<GridCell>());
    std::vector<ContactCells> kept(in.count(sizeof(std::int64_t)));
    for (ContactCells &cells : kept)
      cells = std::make_shared<const std::vector<ContactCell>>(unpack_cells(in));
    std::vector<PositionResult> band(in.count(least_bytes));
    for (PositionResult &result : band)
      {
        each_plain(result, [&](auto &value) { value = in.value<std::decay_t<decltype(value)>>(); });
        result.pairs = in.values<PairLoad>();
        result.lines = in.values<LineLoad>();
        const auto failure = in.values<char>();
        result.failure.assign(failure.begin(), failure.end());
        result.grid_cells = of_number(grids, in.value<int>());
        result.cell_forces = in.values<double>();
        result.contact_cells = of_number(kept, in.value<int>());
        if (result.contact_cells)
          {
            result.contact_force = unpack_vector(in);
            result.contact_gap = unpack_vector(in);
          }
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
              if (!is_finite(r) || (!r.certificate.holds() && r.failure.empty()) || r.cells < 0 ||
                  r.torque != torques[t] || r.phase != phase + cycle ||
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
