// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/pair/position_record.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    /// The one list of what a record holds of a result; the cells come by the numbers of their lists.
    template <class Archive, class Result>
    void fields_of_result(Archive &archive, Result &r, auto &grid, auto &kept)
    {
      archive.fields(r.torque, r.phase, r.theta, r.stiffness, r.gear_torque, r.max_pressure, r.edge_pressure,
                     r.max_pressure_roll, r.max_pressure_z, r.shuttling_moment, r.load_centre,
                     r.max_line_load, r.tip_edge_load, r.end_intensity, r.end_power, r.tip_intensity,
                     r.tip_power, r.tilt[0], r.tilt[1], r.tilt[2], r.tilt[3]);
      archive.fields(r.certificate, r.asymmetry, r.condition, r.cells, r.pivots, r.grids);
      archive.fields(r.pairs, r.lines, r.failure, grid, r.cell_forces, kept, r.contact_force, r.contact_gap);
      archive.list(r.measured, [](auto &to, auto &found) { to.fields(found.name, found.values); });
    }

    bool is_place(const CellPlace place)
    {
      return static_cast<int>(place) >= 0 && place <= CellPlace::rounded_tip;
    }

    /// The one list of a contact cell's fields.
    template <class Archive, class Cell>
    void fields_of_cell(Archive &archive, Cell &c)
    {
      archive.fields(c.slice, c.area, c.gap, c.lever, c.place, c.tilt[0], c.tilt[1], c.tilt[2], c.tilt[3],
                     c.window_border, c.cut_short);
      for (auto *patch : { &c.pinion, &c.gear })
        {
          archive.fields(patch->tooth, patch->roll, patch->z, patch->half_profile, patch->half_generator);
          archive.list(patch->outline, [](auto &to, auto &corner) { to.fields(corner.x(), corner.y()); });
        }
    }

    /// Looks at fields as an archive packs them: whether all numbers are.
    struct FiniteFields
    {
      bool holds = true;

      template <class... Fields>
      void fields(const Fields &...all)
      {
        const auto look = [&](const auto &field) {
          if constexpr (std::is_floating_point_v<std::decay_t<decltype(field)>>)
            holds = holds && std::isfinite(field);
        };
        (look(all), ...);
      }
      template <class List, class Each>
      void list(const List &entries, const Each &each)
      {
        for (const auto &entry : entries)
          each(*this, entry);
      }
    };

    /// Whether the numbers of kept cells are, and there is a force and a gap a cell.
    bool is_finite(const std::vector<ContactCell> &cells, const PositionResult &r)
    {
      const auto n = static_cast<Eigen::Index>(cells.size());
      FiniteFields finite{ r.contact_force.size() == n && r.contact_gap.size() == n &&
                           r.contact_force.allFinite() && r.contact_gap.allFinite() };
      for (const ContactCell &cell : cells)
        {
          fields_of_cell(finite, cell);
          finite.holds = finite.holds && is_place(cell.place) && cell.area > 0;
        }
      return finite.holds;
    }

    /// Whether all its numbers are, and its cells lie where cells can.
    bool is_finite(const PositionResult &r)
    {
      bool finite = r.tilt.allFinite() && r.condition >= 0; // infinite where loaded cells coincide
      const auto check = [&](const auto... values) { finite = finite && (std::isfinite(values) && ...); };
      check(r.theta, r.stiffness, r.gear_torque, r.max_pressure, r.edge_pressure, r.max_pressure_roll,
            r.max_pressure_z);
      check(r.shuttling_moment, r.load_centre, r.max_line_load, r.tip_edge_load, r.end_intensity, r.end_power,
            r.tip_intensity, r.tip_power, r.asymmetry);
      for (const Measured &found : r.measured)
        for (const double value : found.values)
          check(value);
      for (const PairLoad &load : r.pairs)
        check(load.force, load.max_pressure);
      for (const LineLoad &load : r.lines)
        check(load.z, load.pinion_roll, load.load_per_length, load.max_pressure, load.edge_pressure,
              load.half_width, load.height, load.certainty, load.tip_edge_load, load.tip_intensity,
              load.tip_power);
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
    out.list(grids, [](Packer &to, const GridCells &cells) { to.fields(*cells); });
    out.list(kept, [](Packer &to, const ContactCells &cells) {
      to.list(*cells, [](Packer &of_cell, const ContactCell &cell) { fields_of_cell(of_cell, cell); });
    });
    out.list(band, [&](Packer &to, const PositionResult &result) {
      const int grid = number_in(grids, result.grid_cells), cells = number_in(kept, result.contact_cells);
      fields_of_result(to, result, grid, cells);
    });
  }

  std::vector<PositionResult> unpack_band(Unpacker &in)
  {
    std::vector<GridCells> grids;
    std::vector<ContactCells> kept;
    std::vector<PositionResult> band;
    in.list(grids, [](Unpacker &from, GridCells &cells) {
      cells = std::make_shared<const std::vector<GridCell>>(from.values<GridCell>());
    });
    in.list(kept, [](Unpacker &from, ContactCells &cells) {
      std::vector<ContactCell> read;
      from.list(read, [](Unpacker &of_cell, ContactCell &cell) { fields_of_cell(of_cell, cell); });
      cells = std::make_shared<const std::vector<ContactCell>>(std::move(read));
    });
    in.list(band, [&](Unpacker &from, PositionResult &result) {
      int grid = -1, cells = -1;
      fields_of_result(from, result, grid, cells);
      result.grid_cells = of_number(grids, grid);
      result.contact_cells = of_number(kept, cells);
    });
    return band;
  }

  bool is_band(const std::vector<char> &bytes, const std::vector<double> &torques, const double phase,
               const int cycles, const std::size_t measures)
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
                  (r.torque > 0 && r.failure.empty() && r.measured.size() < measures) ||
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
