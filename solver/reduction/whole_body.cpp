// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/base/errors.hpp"
#include "solver/linear/direct_solver.hpp"
#include "solver/reduction/tooth_responses.hpp"

namespace flank
{
  namespace
  {
    /// Displacements along the normals of the flanks of `outputs` for unit loads on the flank of `loaded`, in
    /// a body of `teeth` sectors.
    ToothResponses responses(const ToothSector &sector, const HexMesh &mesh, const int teeth,
                             const bool clamped_cuts, const int loaded, const std::vector<int> &outputs)
    {
      const Gear &gear = sector.gear;
      const auto made =
          make_elastic_body(mesh, sector.resolution.degree, gear.youngs_modulus, gear.poissons_ratio);
      const ElasticBody &body = *made;
      const FlankSurface surface = flank_surface(sector);
      std::vector<char> held = bore_unknowns(sector, body, teeth);
      if (clamped_cuts)
        for (const auto &cut :
             { cut_nodes(sector, body, false, 0), cut_nodes(sector, body, true, teeth - 1) })
          for (const int node : cut)
            for (int c = 0; c < 3; ++c)
              held[3 * node + c] = 1;
      const auto solver = make_direct_solver(body.stiffness(), held);
      const Eigen::Matrix3Xd normals = flank_normals(sector, surface);
      const auto turned = [&](const int tooth) -> Eigen::Matrix3Xd {
        return Eigen::AngleAxisd(tooth * gear.pitch_angle(), Eigen::Vector3d::UnitZ()).toRotationMatrix() *
               normals;
      };
      std::vector<std::vector<int>> nodes;
      std::vector<Eigen::Matrix3Xd> directions;
      for (const int tooth : outputs)
        {
          nodes.push_back(flank_nodes(sector, surface, body, 0, tooth));
          directions.push_back(turned(tooth));
        }
      const auto at = flank_nodes(sector, surface, body, 0, loaded);
      const Eigen::Matrix3Xd push = turned(loaded);
      ToothResponses result(outputs.size(), Eigen::MatrixXd(surface.n_nodes(), surface.n_nodes()));
      for (int j = 0; j < surface.n_nodes(); ++j)
        {
          Eigen::VectorXd load = Eigen::VectorXd::Zero(body.n_unknowns());
          load.segment<3>(3 * at[j]) = push.col(j);
          const Eigen::VectorXd moved = solver->solve(load);
          for (std::size_t o = 0; o < outputs.size(); ++o)
            for (int i = 0; i < surface.n_nodes(); ++i)
              result[o](i, j) = directions[o].col(i).dot(moved.segment<3>(3 * nodes[o][i]));
        }
      return result;
    }
  } // namespace

  ToothResponses direct_ring_responses(const ToothSector &sector, const int max_offset)
  {
    std::vector<int> outputs;
    for (int m = 0; m <= max_offset; ++m)
      outputs.push_back(m);
    return responses(sector, joined_sectors(sector, sector.gear.teeth), sector.gear.teeth, false, 0, outputs);
  }

  ToothResponses direct_segment_responses(const ToothSector &sector, const int teeth, const bool clamped_cuts,
                                          const int max_offset)
  {
    std::vector<int> outputs;
    for (int t = 0; t < teeth; ++t)
      outputs.push_back(t);
    const int centre = teeth / 2;
    const ToothResponses of =
        responses(sector, joined_sectors(sector, teeth), teeth, clamped_cuts, centre, outputs);
    ToothResponses result{ of[centre] };
    for (int m = 1; m <= max_offset; ++m)
      result.push_back(m > centre ? Eigen::MatrixXd(0 * of[centre])
                                  : Eigen::MatrixXd(0.5 * (of[centre + m] + of[centre - m].transpose())));
    return result;
  }
} // namespace flank
