// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/matching/flank_edges.hpp"
#include "mesh/base/gauss.hpp"
#include "solver/elements/flank_block.hpp"
#include "solver/elements/lagrange.hpp"

namespace flank
{
  /// The half-space's field below a unit point force on a flank: of wedges, where it leaves edges free.
  struct SourceField
  {
    const FlankEdges &edges;
    FreeEdges free;
    FlankEdges::Place force;
  };

  /// Nodal forces of sigma(u_s).n on a block's true free faces, u_s the field of a unit point force on the
  /// flank, but for an end that the field leaves free. Each face is halved until a part is no longer than its
  /// distance from the force.
  class FreeFaceForces
  {
  public:
    /// `points`: TableFineness::points. `block` is kept by reference.
    FreeFaceForces(const FlankBlock &block, const LagrangePolynomials &polynomials, int points);

    /// Adds to `force` the nodal forces [N] of a unit point force at the origin of `below`: one entry a
    /// column of FlankBlock::face_response. Not for several threads at once.
    void add(const TangentHalfSpace &below, const SourceField &field, Eigen::Ref<Eigen::VectorXd> force);

  private:
    static constexpr int max_points = LagrangePolynomials::max_points;
    using Shapes = LagrangePolynomials::WithDerivatives;
    using OfNodes =
        std::array<Eigen::Vector3d, max_points * max_points>; ///< of a face, in the half-space's axes

    /// A rectangle of a face's reference coordinates.
    struct Part
    {
      double low1, size1, low2, size2;
    };

    /// The face along its first axis at a place of the second: what a polynomial of the first is multiplied
    /// with.
    struct Line
    {
      std::array<Eigen::Vector3d, max_points> x, d2;
    };

    /// A place on the face and its derivatives along both axes.
    struct Point
    {
      Eigen::Vector3d x = Eigen::Vector3d::Zero(), d1 = x, d2 = x;
    };

    Line line(const Shapes &second) const;
    Point point(const Shapes &first, const Line &line) const;

    /// Adds the forces of a stress at places relative to the load, over the face at hand. Its source lies
    /// `beyond` the load [mm]: parts are halved until they are no longer than their distance from it.
    template <class Stress>
    void integrate(double outward, double beyond, const Stress &stress, OfNodes &sum);

    template <class Stress>
    void integrate(const Stress &stress, const Part &part, const GaussRule &rule, double outward,
                   OfNodes &sum) const;

    const FlankBlock &block_;
    LagrangePolynomials polynomials_;
    int n_; ///< nodes along an edge
    const GaussRule &close_, &far_;
    std::vector<Part> parts_;
    OfNodes nodes_; ///< of the face at hand
  };
} // namespace flank
