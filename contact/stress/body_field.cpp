// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/stress/body_field.hpp"

#include "mesh/base/parallel.hpp"
#include "mesh/base/units.hpp"

#include <Eigen/Eigenvalues>

#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

namespace flank
{
  TeethLoads flank_loads(const FlankSurface &surface, const PositionResult &result, const Side side)
  {
    TeethLoads loads;
    each_loaded_patch(result, side, [&](const Patch &patch, const double force) {
      Eigen::VectorXd &load =
          loads.try_emplace(patch.tooth, Eigen::VectorXd::Zero(surface.n_nodes())).first->second;
      const PatchWeights weights(surface, { patch });
      for (std::size_t k = 0; k < weights.nodes(0).size(); ++k)
        load[weights.nodes(0)[k]] += force * weights.values(0)[k];
    });
    return loads;
  }

  std::vector<FieldPiece::Array> body_arrays(const bool with_displacement, const bool with_stress)
  {
    std::vector<FieldPiece::Array> arrays;
    if (with_displacement)
      arrays.push_back({ "displacement_mm", 3 });
    if (with_stress)
      arrays.insert(arrays.end(),
                    { { "stress_MPa", 9 }, { "von_mises_MPa", 1 }, { "principal_stresses_MPa", 3 } });
    arrays.insert(arrays.end(), { { "body_1_pinion_2_gear", 1 }, { "tooth", 1 } });
    return arrays;
  }

  namespace
  {
    /// Where a loaded element is cut into finer cells: along the profile, in depth, along the face. Stresses
    /// below a contact change over the contact's width, some tenths of a millimetre, and most just below the
    /// surface.
    const std::array<std::vector<double>, 3> finer{
      { { 0, 0.25, 0.5, 0.75, 1 }, { 0, 0.08, 0.25, 0.5, 1 }, { 0, 0.5, 1 } }
    };

    /// Reference points of an element cut along `breaks`, each once, and the points of each finer cell in
    /// FieldPiece's order.
    struct FinerCells
    {
      FinerCells(const std::array<std::vector<double>, 3> &breaks, const int degree)
      {
        std::array<std::vector<double>, 3> at;
        for (int axis = 0; axis < 3; ++axis)
          {
            at[axis].push_back(breaks[axis].front());
            for (std::size_t k = 0; k + 1 < breaks[axis].size(); ++k)
              for (int i = 1; i <= degree; ++i)
                at[axis].push_back(breaks[axis][k] + (breaks[axis][k + 1] - breaks[axis][k]) * i / degree);
          }
        const auto n = [&](const int axis) { return static_cast<int>(at[axis].size()); };
        for (const double z : at[2])
          for (const double y : at[1])
            for (const double x : at[0])
              points.emplace_back(x, y, z);
        for (int c = 0; c + degree < n(2); c += degree)
          for (int b = 0; b + degree < n(1); b += degree)
            for (int a = 0; a + degree < n(0); a += degree)
              {
                std::vector<int> &cell = cells.emplace_back();
                for (int k = c; k <= c + degree; ++k)
                  for (int j = b; j <= b + degree; ++j)
                    for (int i = a; i <= a + degree; ++i)
                      cell.push_back((k * n(1) + j) * n(0) + i);
              }
      }
      std::vector<Eigen::Vector3d> points;
      std::vector<std::vector<int>> cells;
    };

    /// Some elements of one tooth, all as they are or all cut finer; the order of the result does not depend
    /// on who does it.
    struct Job
    {
      const ToothField *of;
      bool joined, finer;
      std::vector<int> cells; ///< of the sector, or of the region where joined
    };

    std::vector<Job> jobs_of(const ToothSector &sector, const ContactRegion &region,
                             const std::vector<ToothField> &teeth)
    {
      const SectorResolution &size = sector.resolution;
      std::vector<Job> jobs;
      for (const ToothField &tooth : teeth)
        {
          Job plain{ .of = &tooth, .joined = false, .finer = false, .cells = {} };
          for (std::size_t cell = 0; cell < sector.mesh.cells.size(); ++cell)
            if (!tooth.contact || region.of_sector_cell(static_cast<int>(cell)) < 0)
              plain.cells.push_back(static_cast<int>(cell));
          jobs.push_back(std::move(plain));
          for (int layer = 0; tooth.contact && layer < size.face_layers; ++layer)
            {
              Job joined{ .of = &tooth, .joined = true, .finer = false, .cells = {} },
                  loaded{ .of = &tooth, .joined = true, .finer = true, .cells = {} };
              for (int column = 0; column < size.tooth_columns; ++column)
                for (int row = 0; row < size.flank_rows; ++row)
                  if (const int cell = region.of_sector_cell(sector.tooth_cell(row, column, layer));
                      cell >= 0)
                    (column == 0 && tooth.contact->on(row, layer) ? loaded : joined).cells.push_back(cell);
              jobs.push_back(std::move(joined));
              jobs.push_back(std::move(loaded));
            }
        }
      return jobs;
    }

    /// A point's column of values, but for body and tooth at its end.
    void write_point(const Placement &place, const Eigen::Vector3d &position, const NearLoads::Field &field,
                     const bool with_displacement, const bool with_stress, Eigen::Ref<Eigen::VectorXd> values)
    {
      values.head<3>() = place.point(position);
      Eigen::Index row = 3;
      if (with_displacement)
        {
          values.segment<3>(row) = place.vector(field.displacement);
          row += 3;
        }
      if (!with_stress)
        return;
      const Eigen::Matrix3d stress = place.tensor(field.stress);
      const Eigen::Vector3d ascending =
          Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(stress, Eigen::EigenvaluesOnly).eigenvalues();
      values.segment<9>(row) = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(stress.data());
      values[row + 9] = half_space::von_mises(stress);
      values.segment<3>(row + 10) = ascending.reverse();
    }
  } // namespace

  FieldPiece body_field(const BodyElements &elements, const ContactRegion &region, const Placement &placement,
                        const Side side, const std::vector<ToothField> &teeth, const bool with_displacement,
                        const bool with_stress)
  {
    const ToothSector &sector = elements.sector();
    const int degree = sector.resolution.degree;
    FieldPiece piece{ .dimension = 3,
                      .degree = degree,
                      .arrays = body_arrays(with_displacement, with_stress) };
    Eigen::Index n_rows = 3;
    for (const auto &array : piece.arrays)
      n_rows += array.components;

    const std::vector<Job> jobs = jobs_of(sector, region, teeth);
    const FinerCells whole({ { { 0, 1 }, { 0, 1 }, { 0, 1 } } }, degree), cut(finer, degree);
    std::vector<std::vector<Eigen::MatrixXd>> done(jobs.size());
    parallel_for(static_cast<int>(jobs.size()), [&](const int number) {
      const Job &job = jobs[number];
      const FinerCells &shown = job.finer ? cut : whole;
      const Placement place = of_tooth(placement, sector.gear, job.of->tooth);
      Eigen::MatrixXd values(n_rows, static_cast<Eigen::Index>(shown.points.size()));
      const auto use = [&](int, const ElasticBody::Samples &s) {
        for (Eigen::Index q = 0; q < values.cols(); ++q)
          {
            NearLoads::Field field;
            if (job.joined)
              field = job.of->contact->at(s.position.col(q));
            field.displacement += s.displacement.col(q);
            field.stress += stress_tensor(s.stress.col(q));
            write_point(place, s.position.col(q), field, with_displacement, with_stress, values.col(q));
            values(n_rows - 2, q) = side == Side::pinion ? 1 : 2;
            values(n_rows - 1, q) = job.of->tooth;
          }
        for (const std::vector<int> &cell : shown.cells)
          done[number].push_back(values(Eigen::all, cell));
      };
      const ElasticBody &body = job.joined ? region.body() : elements.body();
      body.each_sample(job.cells, shown.points, job.joined ? job.of->without_contact : job.of->displacement,
                       use);
    });
    for (auto &cells : done)
      std::move(cells.begin(), cells.end(), std::back_inserter(piece.cells));
    return piece;
  }

  FieldPiece contact_field(const GearPair &pair, const PositionResult &result)
  {
    const std::vector<FieldPiece::Array> arrays = {
      { "pressure_MPa", 1 },         { "gap_um", 1 },     { "force_N", 1 },           { "area_mm2", 1 },
      { "body_1_pinion_2_gear", 1 }, { "tooth_pair", 1 }, { "load_share_of_pair", 1 }
    };
    FieldPiece piece{ .dimension = 2, .degree = 1, .arrays = arrays };
    std::map<int, double> share;
    for (const PairLoad &load : result.pairs)
      share[load.pair] = load_share(result, load);
    for (const Side side : { Side::pinion, Side::gear })
      for (std::size_t i = 0; i < result.contact_cells->size(); ++i)
        {
          const ContactCell &cell = (*result.contact_cells)[i];
          const bool first = side == Side::pinion;
          const Gear &gear = first ? pair.pinion : pair.gear;
          const Patch &patch = first ? cell.pinion : cell.gear;
          const Placement place = of_tooth(placement_of(pair, side, result.phase), gear, patch.tooth);
          const InvoluteHelicoid flank = gear.flank();
          const double force = result.contact_force[static_cast<Eigen::Index>(i)];
          Eigen::MatrixXd values(10, 4);
          for (int corner = 0; corner < 4; ++corner)
            {
              const double x = (corner % 2 ? 1 : -1) * patch.half_profile,
                           y = (corner / 2 ? 1 : -1) * patch.half_generator;
              const double roll = std::sqrt(std::max(0.0, flank.roll_squared(patch.roll, x, y)));
              values.col(corner) << place.point(
                  flank.frame(roll, patch.z + y * flank.cos_base_helix()).origin),
                  force / cell.area, result.contact_gap[static_cast<Eigen::Index>(i)] / units::micrometre,
                  force, cell.area, first ? 1 : 2, cell.pinion.tooth, share[cell.pinion.tooth];
            }
          piece.cells.push_back(std::move(values));
        }
    return piece;
  }
} // namespace flank
