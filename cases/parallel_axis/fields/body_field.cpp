// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/fields/body_field.hpp"

#include "mesh/base/units.hpp"

#include <Eigen/Eigenvalues>

#include <numeric>

namespace flank
{
  TeethLoads flank_loads(const FlankSurface &surface, const PositionResult &result, const Side side)
  {
    TeethLoads loads;
    for (std::size_t i = 0; i < result.contact_cells->size(); ++i)
      if (const double force = result.contact_force[static_cast<Eigen::Index>(i)]; force > 0)
        {
          const ContactCell &cell  = (*result.contact_cells)[i];
          const Patch       &patch = side == Side::pinion ? cell.pinion : cell.gear;
          Eigen::VectorXd   &load  = loads.try_emplace(patch.tooth, Eigen::VectorXd::Zero(surface.n_nodes())).first->second;
          const PatchWeights w     = patch_weights(surface, patch);
          for (std::size_t k = 0; k < w.node.size(); ++k)
            load[w.node[k]] += force * w.value[k];
        }
    return loads;
  }

  std::vector<FieldPiece::Array> body_arrays(const bool with_displacement, const bool with_stress)
  {
    std::vector<FieldPiece::Array> arrays;
    if (with_displacement)
      arrays.push_back({ "displacement_mm", 3 });
    if (with_stress)
      arrays.insert(arrays.end(), { { "stress_MPa", 9 }, { "von_mises_MPa", 1 }, { "principal_stresses_MPa", 3 } });
    arrays.insert(arrays.end(), { { "body_1_pinion_2_gear", 1 }, { "tooth", 1 } });
    return arrays;
  }

  FieldPiece body_field(const BodyElements &elements, const Placement &placement, const Side side, const std::vector<int> &teeth,
                        const std::vector<Eigen::VectorXd> &displacement, const bool with_displacement, const bool with_stress)
  {
    const ElasticBody &body = elements.body();
    FieldPiece         piece{ 3, body.degree(), body_arrays(with_displacement, with_stress), {} };
    Eigen::Index       n_rows = 3;
    for (const auto &array : piece.arrays)
      n_rows += array.components;

    const std::vector<Eigen::Vector3d> points = FieldPiece::points(3, body.degree());
    std::vector<int>                   cells(elements.sector().mesh.cells.size());
    std::iota(cells.begin(), cells.end(), 0);
    for (std::size_t t = 0; t < teeth.size(); ++t)
      {
        const Placement place = of_tooth(placement, elements.sector().gear, teeth[t]);
        body.each_sample(cells, points, displacement[t], [&](int, const ElasticBody::Samples &s) {
          Eigen::MatrixXd values(n_rows, s.position.cols());
          for (Eigen::Index q = 0; q < values.cols(); ++q)
            {
              Eigen::Index row        = 3;
              values.col(q).head<3>() = place.point(s.position.col(q));
              if (with_displacement)
                {
                  values.col(q).segment<3>(row) = place.vector(s.displacement.col(q));
                  row += 3;
                }
              if (with_stress)
                {
                  const Eigen::Matrix3d stress   = place.tensor(stress_tensor(s.stress.col(q))),
                                        deviator = stress - stress.trace() / 3 * Eigen::Matrix3d::Identity();
                  const Eigen::Vector3d principal =
                      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(stress, Eigen::EigenvaluesOnly).eigenvalues().reverse();
                  values.col(q).segment<9>(row)      = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(stress.data());
                  values(row + 9, q)                 = std::sqrt(1.5) * deviator.norm();
                  values.col(q).segment<3>(row + 10) = principal;
                  row += 13;
                }
              values(row, q)     = side == Side::pinion ? 1 : 2;
              values(row + 1, q) = teeth[t];
            }
          piece.cells.push_back(std::move(values));
        });
      }
    return piece;
  }

  FieldPiece contact_field(const GearPair &pair, const PositionResult &result)
  {
    const std::vector<FieldPiece::Array> arrays = { { "pressure_MPa", 1 },         { "gap_um", 1 },    { "force_N", 1 }, { "area_mm2", 1 },
                                                    { "body_1_pinion_2_gear", 1 }, { "tooth_pair", 1 } };
    FieldPiece                           piece{ 2, 1, arrays, {} };
    for (const Side side : { Side::pinion, Side::gear })
      for (std::size_t i = 0; i < result.contact_cells->size(); ++i)
        {
          const ContactCell     &cell  = (*result.contact_cells)[i];
          const bool             first = side == Side::pinion;
          const Gear            &gear  = first ? pair.pinion : pair.gear;
          const Patch           &patch = first ? cell.pinion : cell.gear;
          const Placement        place = of_tooth(placement_of(pair, side, result.phase), gear, patch.tooth);
          const InvoluteHelicoid flank = gear.flank();
          const double           force = result.contact_force[static_cast<Eigen::Index>(i)];
          Eigen::MatrixXd        values(9, 4);
          for (int corner = 0; corner < 4; ++corner)
            {
              const double x = (corner % 2 ? 1 : -1) * patch.half_profile, y = (corner / 2 ? 1 : -1) * patch.half_generator;
              const double along = patch.roll + y * flank.roll_per_generator();
              const double roll  = std::sqrt(std::max(0.0, along * along + 2 * x / flank.base_radius()));
              values.col(corner) << place.point(flank.frame(roll, patch.z + y * flank.cos_base_helix()).origin), force / cell.area,
                  result.contact_gap[static_cast<Eigen::Index>(i)] / units::micrometre, force, cell.area, first ? 1 : 2, cell.pinion.tooth;
            }
          piece.cells.push_back(std::move(values));
        }
    return piece;
  }
} // namespace flank
