// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/loaded/position_result.hpp"

#include "contact/loaded/edge_intensity.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace flank
{
  namespace
  {
    /// How much of the common face width counts as an end of it, where forces per length of edge grow as
    /// slices shrink.
    constexpr double end_of_face = 0.05;

    /// Cosine of the helix angle of the tip edge that a slice beyond the path of action touches with.
    double cos_helix_of_tip_edge(const GearPair &pair, const Slice &slice)
    {
      const bool is_of_pinion = slice.pinion_roll >= pair.pinion.usable_tip_roll;
      const Gear &gear = is_of_pinion ? pair.pinion : pair.gear;
      return 1 / std::hypot(1, gear.flank().twist() * gear.usable_tip_radius());
    }

    /// Loads of the slices, as points of the contact lines.
    std::vector<LineLoad> line_loads(const GearPair &pair, const PositionGrid &grid,
                                     const ContactSolution &solution, const LineContacts &contacts,
                                     const double z_sign)
    {
      std::vector<LineLoad> lines(grid.slices().size());
      const std::vector<EdgeIntensity> at_tips = intensities_at_tips(pair, grid, solution.force);
      std::vector<double> moment(lines.size(), 0.0), low(lines.size(), 1e300), high(lines.size(), -1e300);
      const double per_length = std::cos(pair.base_helix_angle), rb = pair.pinion.base_radius;
      for (const int i : solution.active)
        {
          const ContactCell &cell = grid.cells()[i];
          const Slice &slice = grid.slices()[cell.slice];
          LineLoad &line = lines[cell.slice];
          const double along = profile_length(slice.pinion_roll, cell.pinion.roll, rb);
          line.load_per_length += solution.force[i] * per_length / slice.height;
          const double pressure = contacts.pressure[i];
          line.max_pressure = std::max(line.max_pressure, pressure);
          line.edge_pressure = std::max(line.edge_pressure, is_sharp(cell.place) ? pressure : 0);
          moment[cell.slice] += solution.force[i] * per_length / slice.height * along;
          low[cell.slice] = std::min(low[cell.slice], along - cell.pinion.half_profile);
          high[cell.slice] = std::max(high[cell.slice], along + cell.pinion.half_profile);
        }
      for (std::size_t s = 0; s < lines.size(); ++s)
        {
          const Slice &slice = grid.slices()[s];
          lines[s].certainty = contacts.certainty[s];
          lines[s].pair = slice.pair;
          lines[s].z = z_sign * slice.z;
          lines[s].height = slice.height;
          lines[s].half_width = std::max(0.0, (high[s] - low[s]) / 2);
          lines[s].tip_intensity = at_tips[s].intensity, lines[s].tip_power = at_tips[s].power;
          if (slice.tip_edge)
            lines[s].tip_edge_load =
                lines[s].load_per_length / per_length * cos_helix_of_tip_edge(pair, slice);
          const double centre = lines[s].load_per_length > 0 ? moment[s] / lines[s].load_per_length : 0;
          lines[s].pinion_roll =
              std::sqrt(std::max(0.0, pair.pinion.flank().roll_squared(slice.pinion_roll, centre, 0)));
        }
      std::erase_if(lines, [](const LineLoad &line) { return line.load_per_length == 0; });
      return lines;
    }
  } // namespace

  double transmission_error(const GearPair &pair, const PositionResult &result)
  {
    return pair.pinion.base_radius * result.theta;
  }

  double tangent_stiffness(const GearPair &pair, const PositionResult &result)
  {
    return result.stiffness / (pair.pinion.base_radius * pair.pinion.base_radius);
  }

  double secant_stiffness(const GearPair &pair, const PositionResult &result)
  {
    return secant_stiffness(pair, result.torque, transmission_error(pair, result));
  }

  double secant_stiffness(const GearPair &pair, const double torque, const double transmission_error)
  {
    return transmission_error != 0 ? torque / pair.pinion.base_radius / transmission_error : 0;
  }

  std::vector<double> measured(const PositionResult &result, const std::string &name)
  {
    const auto found = std::ranges::find(result.measured, name, &Measured::name);
    return found != result.measured.end() ? found->values : std::vector<double>();
  }

  double load_share(const PositionResult &result, const PairLoad &load)
  {
    double total = 0;
    for (const PairLoad &pair : result.pairs)
      total += pair.force;
    return load.force / total;
  }

  GridCells grid_cells_of(const GearPair &pair, const PositionGrid &grid)
  {
    const double z_sign = canonical_z_sign(pair.data);
    std::vector<GridCell> cells;
    for (std::size_t i = 0; i < grid.cells().size(); ++i)
      {
        const ContactCell &cell = grid.cells()[i];
        cells.push_back({ .pair = cell.pinion.tooth,
                          .z = z_sign * cell.pinion.z,
                          .pinion_roll = cell.pinion.roll,
                          .gear_roll = cell.gear.roll,
                          .area = cell.area,
                          .gap = grid.problem().gap[i],
                          .place = cell.place });
      }
    return std::make_shared<const std::vector<GridCell>>(std::move(cells));
  }

  PositionResult position_result(const GearPair &pair, const double phase, const PositionGrid &grid,
                                 const ContactSolution &solution, const LineContacts &contacts,
                                 const Turned &turned, const Certificate &certificate,
                                 const GridCells &grid_cells)
  {
    const double z_sign = canonical_z_sign(pair.data);
    PositionResult result;
    result.torque = solution.torque;
    result.phase = phase;
    result.theta = turned.theta;
    result.stiffness = turned.stiffness;
    result.certificate = certificate;
    result.asymmetry = grid.asymmetry();
    result.cells = static_cast<int>(grid.cells().size());
    result.pivots = solution.pivots;
    result.grids = grid.windows().grids;
    result.tilt = z_sign * grid.tilt(solution.force);
    result.grid_cells = grid_cells;
    if (grid_cells)
      result.cell_forces.assign(solution.force.data(), solution.force.data() + solution.force.size());
    std::map<int, PairLoad> loads;
    double total = 0;
    for (std::size_t i = 0; i < grid.cells().size(); ++i)
      {
        const ContactCell &cell = grid.cells()[i];
        const double force = solution.force[i], pressure = contacts.pressure[static_cast<Eigen::Index>(i)];
        PairLoad &load =
            loads
                .try_emplace(cell.pinion.tooth,
                             PairLoad{ .pair = cell.pinion.tooth, .force = 0, .max_pressure = 0 })
                .first->second;
        load.force += force;
        load.max_pressure = std::max(load.max_pressure, pressure);
        total += force;
        result.gear_torque += force * grid.slices()[cell.slice].gear_lever;
        result.shuttling_moment += force * std::cos(pair.base_helix_angle) * z_sign * cell.pinion.z;
        if (is_sharp(cell.place))
          result.edge_pressure = std::max(result.edge_pressure, pressure);
        else if (pressure > result.max_pressure)
          {
            result.max_pressure = pressure;
            result.max_pressure_roll = cell.pinion.roll;
            result.max_pressure_z = z_sign * cell.pinion.z;
          }
      }
    if (total > 0)
      result.load_centre = result.shuttling_moment / (total * std::cos(pair.base_helix_angle));
    for (const auto &[k, load] : loads)
      if (load.force > 0)
        result.pairs.push_back(load);
    const EdgeIntensity at_ends = intensity_at_ends(grid, contacts.pressure);
    result.end_intensity = at_ends.intensity, result.end_power = at_ends.power;
    result.lines = line_loads(pair, grid, solution, contacts, z_sign);
    const double beside = end_of_face * pair.common_face_width;
    for (const LineLoad &line : result.lines)
      {
        result.max_line_load = std::max(result.max_line_load, line.load_per_length);
        if (line.z - line.height / 2 > pair.face_low + beside &&
            line.z + line.height / 2 < pair.face_high - beside)
          {
            result.tip_edge_load = std::max(result.tip_edge_load, line.tip_edge_load);
            if (line.tip_intensity > result.tip_intensity)
              result.tip_intensity = line.tip_intensity, result.tip_power = line.tip_power;
          }
      }
    return result;
  }
} // namespace flank
