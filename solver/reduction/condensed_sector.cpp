// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/reduction/condensed_sector.hpp"

#include "mesh/base/errors.hpp"
#include "solver/linear/direct_solver.hpp"
#include "solver/parallel_session.hpp"
#include "solver/reduction/distributed_condensation.hpp"

namespace flank
{
  namespace
  {
    /// Unknowns held at zero: the bore's, and on the mid-plane those that its symmetry forbids.
    std::vector<char> held_unknowns(const ToothSector &sector, const ElasticBody &body,
                                    const MidPlane mid_plane)
    {
      std::vector<char> held = bore_unknowns(sector, body);
      if (mid_plane != MidPlane::none)
        for (int node = 0; node < body.n_nodes(); ++node)
          if (body.node_positions()[node].z() > sector.gear.face_width / 2 * (1 - 1e-9))
            for (int c = 0; c < 3; ++c)
              if ((c == 2) == (mid_plane == MidPlane::symmetric))
                held[3 * node + c] = 1;
      return held;
    }

    /// The Schur complement of all of `kept`, where some are held: rows of a unit diagonal, coupled to
    /// nothing.
    Eigen::MatrixXd with_held(const Eigen::MatrixXd &schur, const std::vector<int> &kept,
                              const std::vector<char> &held)
    {
      std::vector<Eigen::Index> free;
      for (std::size_t k = 0; k < kept.size(); ++k)
        if (!held[kept[k]])
          free.push_back(static_cast<Eigen::Index>(k));
      if (free.size() == kept.size())
        return schur;
      Eigen::MatrixXd result = Eigen::MatrixXd::Identity(kept.size(), kept.size());
      result(free, free) = schur;
      return result;
    }
    /// A spur tooth is mirrored in the plane through its middle and the axis, a helical one is turned half
    /// round about the radius through its middle at mid-face. Taken where the stiffness of the cuts has it,
    /// to the rounding of the condensation.
    std::optional<CondensedSector::CutSymmetry> cut_symmetry(const ToothSector &sector,
                                                             const ElasticBody &body,
                                                             const CondensedSector &cuts)
    {
      const bool half_turn = sector.gear.helix_angle != 0;
      CondensedSector::CutSymmetry symmetry;
      const Eigen::Matrix3d of_tooth =
          Eigen::Vector3d(1, -1, half_turn ? -1 : 1).asDiagonal(); // tooth 0 is centred on +x
      symmetry.turn =
          Eigen::AngleAxisd(-sector.gear.pitch_angle(), Eigen::Vector3d::UnitZ()).toRotationMatrix() *
          of_tooth;

      // Places of the nodes of a cut: radius and z.
      std::vector<Eigen::Vector2d> place;
      for (const int node : cut_nodes(sector, body, false))
        place.emplace_back(body.node_positions()[node].head<2>().norm(), body.node_positions()[node].z());
      const double near = 1e-6 * sector.gear.face_width;
      for (const Eigen::Vector2d &from : place)
        {
          const Eigen::Vector2d to(from.x(), half_turn ? -from.y() : from.y());
          const auto found = std::find_if(place.begin(), place.end(),
                                          [&](const auto &at) { return (at - to).norm() < near; });
          if (found == place.end())
            return {};
          symmetry.image.push_back(static_cast<int>(found - place.begin()));
        }

      const auto image_of = [&](const Eigen::MatrixXd &m) { // T m T
        Eigen::MatrixXd result(m.rows(), m.cols());
        for (std::size_t i = 0; i < symmetry.image.size(); ++i)
          for (std::size_t j = 0; j < symmetry.image.size(); ++j)
            result.block<3, 3>(3 * symmetry.image[i], 3 * symmetry.image[j]) =
                symmetry.turn * m.block<3, 3>(3 * i, 3 * j) * symmetry.turn.transpose();
        return result;
      };
      const double difference =
          (image_of(cuts.minus_minus) - cuts.plus_plus).cwiseAbs().maxCoeff() +
          (image_of(cuts.plus_minus) - cuts.plus_minus.transpose()).cwiseAbs().maxCoeff();
      if (difference > 1e-10 * cuts.minus_minus.cwiseAbs().maxCoeff())
        return {};
      return symmetry;
    }

    /// Keeps the flank and the planes of nodes below it. Loads and outputs are along the surface's normals:
    /// each node of a plane has axes of its own, of which the first, the normal above it, is kept. Of a spur
    /// tooth the third is z, so that what a mid-plane holds stays what it was.
    NodeAxes keep_flank(const ToothSector &sector, const ElasticBody &body, const int depth_planes,
                        std::vector<int> &kept)
    {
      const FlankSurface surface = flank_surface(sector);
      const Eigen::Matrix3Xd normals = flank_normals(sector, surface);
      NodeAxes axes;
      for (int d = 0; d <= depth_planes; ++d)
        {
          const std::vector<int> nodes = flank_nodes(sector, surface, body, d);
          for (std::size_t i = 0; i < nodes.size(); ++i)
            {
              const Eigen::Vector3d normal = normals.col(static_cast<Eigen::Index>(i)),
                                    aside = Eigen::Vector3d::UnitZ().cross(normal).normalized();
              axes[nodes[i]] << normal, aside, normal.cross(aside);
              kept.push_back(3 * nodes[i]);
            }
        }
      return axes;
    }

    /// Cuts with the inner unknowns eliminated, loaded along some directions of these, the first n_flank of
    /// which are loads.
    CondensedSector eliminate_inner(const Eigen::MatrixXd &schur, const Eigen::MatrixXd &direction,
                                    const Eigen::Index n_flank)
    {
      const Eigen::Index n_inner = direction.rows(), n = (schur.rows() - n_inner) / 2;
      const Eigen::LLT<Eigen::MatrixXd> inner(schur.bottomRightCorner(n_inner, n_inner));
      if (inner.info() != Eigen::Success)
        throw ComputationError("the condensed flank stiffness is not positive definite");
      const Eigen::MatrixXd half_direction = inner.matrixL().solve(direction),
                            half_coupling = inner.matrixL().solve(schur.bottomLeftCorner(n_inner, 2 * n));
      const Eigen::MatrixXd cut =
          schur.topLeftCorner(2 * n, 2 * n) - half_coupling.transpose() * half_coupling;
      const Eigen::MatrixXd load = -half_coupling.transpose() * half_direction.leftCols(n_flank);
      const Eigen::MatrixXd output = -half_direction.transpose() * half_coupling;

      CondensedSector result;
      result.own = half_direction.transpose() * half_direction.leftCols(n_flank);
      result.plus_plus = cut.topLeftCorner(n, n);
      result.plus_minus = cut.topRightCorner(n, n);
      result.minus_minus = cut.bottomRightCorner(n, n);
      result.load_plus = load.topRows(n);
      result.load_minus = load.bottomRows(n);
      result.output_plus = output.leftCols(n);
      result.output_minus = output.rightCols(n);
      return result;
    }

    /// In coordinates that turn with its tooth, the plus cut of a tooth moves with the minus cut of the next:
    /// u_plus(t) = R(pitch) u_minus(t+1).
    void turn_with_teeth(CondensedSector &result, const double pitch)
    {
      const Eigen::Index n = result.plus_plus.rows();
      const Eigen::Matrix3d back =
          Eigen::AngleAxisd(-pitch, Eigen::Vector3d::UnitZ()).toRotationMatrix(); // R'
      for (Eigen::Index i = 0; i < n; i += 3)
        {
          result.load_plus.middleRows<3>(i) = (back * result.load_plus.middleRows<3>(i)).eval();
          result.plus_plus.middleRows<3>(i) = (back * result.plus_plus.middleRows<3>(i)).eval();
          result.plus_minus.middleRows<3>(i) = (back * result.plus_minus.middleRows<3>(i)).eval();
          result.output_plus.middleCols<3>(i) =
              (result.output_plus.middleCols<3>(i) * back.transpose()).eval();
        }
      for (Eigen::Index i = 0; i < n; i += 3)
        result.plus_plus.middleCols<3>(i) = (result.plus_plus.middleCols<3>(i) * back.transpose()).eval();
    }
  } // namespace

  CondensedSector condense_sector(const ToothSector &sector, const ElasticBody &body,
                                  const MidPlane mid_plane, const int depth_planes,
                                  const ParallelSession *distributed, SectorInside *inside)
  {
    const FlankSurface surface = flank_surface(sector);
    std::vector<int> kept;
    const auto keep_cut = [&](const bool plus) {
      for (const int node : cut_nodes(sector, body, plus))
        for (int c = 0; c < 3; ++c)
          kept.push_back(3 * node + c);
    };
    keep_cut(true);
    const auto n = static_cast<Eigen::Index>(kept.size());
    keep_cut(false);
    const NodeAxes axes = keep_flank(sector, body, depth_planes, kept);
    const Eigen::Index n_inner = static_cast<Eigen::Index>(kept.size()) - 2 * n, n_flank = surface.n_nodes();

    const std::vector<char> held = held_unknowns(sector, body, mid_plane);
    std::vector<int> free;
    std::copy_if(kept.begin(), kept.end(), std::back_inserter(free), [&](const int k) { return !held[k]; });
    Eigen::MatrixXd of_free;
    if (distributed)
      of_free = condense_distributed(body, axes, held, free, *distributed);
    else
      {
        Condensation condensation = condense(body.stiffness(axes), held, free, inside != nullptr);
        of_free = std::move(condensation.complement);
        if (inside)
          *inside = { std::move(condensation.inside), axes };
      }
    if (distributed && distributed->rank() != 0)
      return {};
    const Eigen::MatrixXd schur = with_held(of_free, kept, held);

    // Unit loads, of which the surface plane's are used; what is held neither loads nor moves.
    Eigen::MatrixXd direction = Eigen::MatrixXd::Zero(n_inner, n_inner);
    for (Eigen::Index i = 0; i < n_inner; ++i)
      direction(i, i) = held[kept[2 * n + i]] ? 0 : 1;

    CondensedSector result = eliminate_inner(schur, direction, n_flank);
    turn_with_teeth(result, sector.gear.pitch_angle());
    result.symmetry = cut_symmetry(sector, body, result);
    return result;
  }
} // namespace flank
