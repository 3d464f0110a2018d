// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "solver/reduction/body_model.hpp"
#include "solver/reduction/condensed_sector.hpp"

#include <functional>
#include <map>

namespace flank
{
  /// Responses of the teeth near a loaded one: [m](i, j), output i of the tooth m ahead of the loaded one for
  /// a unit load j. Outputs below the flank, where the sector has them, in [0] alone. [mm/N]
  using ToothResponses = std::vector<Eigen::MatrixXd>;

  /// Whole gear from one condensed sector by cyclic symmetry: the discrete Fourier transform over the teeth
  /// turns the ring into one small Hermitian system a harmonic. Exact for the finite-element model.
  ToothResponses ring_responses(const CondensedSector &sector, int teeth, int max_offset);

  /// A segment of an odd number of teeth around the loaded one, its end cuts free or clamped: a chain of
  /// condensed sectors, block tridiagonal. Another tooth's load has another segment, so reciprocity between
  /// teeth holds only nearly: the mean of both directions is returned. Teeth outside the segment do not
  /// respond.
  ToothResponses segment_responses(const CondensedSector &sector, int teeth, bool clamped_cuts,
                                   int max_offset);

  /// Forces along the inward normals of the flank's nodes, by tooth. [N]
  using TeethLoads = std::map<int, Eigen::VectorXd>;

  /// Displacements of the two cuts of a tooth's sector, in the tooth's own axes: the cut before it (minus)
  /// and behind it (plus). [mm]
  struct CutDisplacement
  {
    Eigen::VectorXd minus, plus;
  };

  /// Displacements of some nodes, three unknowns a node, turned about the z axis. [mm, rad]
  inline Eigen::VectorXd turned(const Eigen::VectorXd &displacement, const double angle)
  {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    Eigen::VectorXd result(displacement.size());
    for (Eigen::Index i = 0; i < result.size(); i += 3)
      result.segment<3>(i) = turn * displacement.segment<3>(i);
    return result;
  }

  /// Displacements of the cuts, which the responses above follow from: for each load case those of each
  /// wanted tooth.
  using CutDisplacements = std::vector<std::map<int, CutDisplacement>>;
  CutDisplacements ring_cuts(const CondensedSector &sector, int teeth, const std::vector<TeethLoads> &loads,
                             const std::vector<int> &wanted);
  CutDisplacements segment_cuts(const CondensedSector &sector, const BodyModel &model, double pitch,
                                const std::vector<TeethLoads> &loads, const std::vector<int> &wanted);

  /// Responses of the ring or of the segment, whichever the model says.
  ToothResponses closed_responses(const CondensedSector &sector, const BodyModel &model, int teeth,
                                  int max_offset);

  /// Responses of the whole body from one half of it: a load on one side of the mid-plane is half the sum of
  /// a symmetric and an antisymmetric pair of loads, each of which one half of the body answers. `finished`
  /// is told every stage; collective where `distributed`.
  ToothResponses half_body_responses(const Gear &gear, const SectorResolution &resolution,
                                     const BodyModel &model, int max_offset, int depth_planes,
                                     const ParallelSession *distributed,
                                     const std::function<void(const char *)> &finished);

  /// Responses by a mesh of all the teeth and one sparse factorisation. They share nothing with the ways
  /// above but the elements, and check them.
  ToothResponses direct_ring_responses(const ToothSector &sector, int max_offset);
  ToothResponses direct_segment_responses(const ToothSector &sector, int teeth, bool clamped_cuts,
                                          int max_offset);
} // namespace flank
