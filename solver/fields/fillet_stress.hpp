// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/segment/fillet_block.hpp"
#include "solver/elements/body_elements.hpp"
#include "solver/linear/direct_solver.hpp"

#include <Eigen/SparseCore>

#include <array>
#include <memory>
#include <vector>

namespace flank
{
  /// Stress in the root fillets of a tooth. The sector's elements are as large as a fillet's radius: they
  /// give the displacements at some distance from it, and a block of finer elements about the fillet, held at
  /// its cut by these displacements, gives the stress (a submodel). One factorisation a fillet serves all
  /// teeth and loads.
  class FilletStress
  {
  public:
    /// Of the block's elements: of degree 2 ones as thin as a twentieth of the radius would be needed.
    static constexpr int block_degree = 3;

    /// Meshes and factors the blocks of both fillets. Throws ComputationError.
    explicit FilletStress(const BodyElements &elements);

    /// Greatest principal stress over the arc of either fillet [MPa], tension positive, under displacements
    /// of the sector's nodes in the tooth's axes [mm]: [below the loaded flank, the other][node along the
    /// face]. Where elements meet their values are averaged. Not for several threads at once.
    std::array<std::vector<double>, 2> greatest(const Eigen::VectorXd &displacement) const;

  private:
    /// A fillet's elements, how the sector's displacements hold their cut, and their factor.
    struct Submodel
    {
      Submodel(const BodyElements &elements, int side);
      void hold_cut(const BodyElements &elements);
      std::vector<double> greatest(const Eigen::VectorXd &displacement) const;

      FilletBlock block;
      std::vector<double> face_points; ///< where the sector has nodes along an element's edge
      std::unique_ptr<const ElasticBody> body;
      Eigen::SparseMatrix<double, Eigen::RowMajor> held; ///< the cut's unknowns by the sector's
      std::unique_ptr<const DirectSolver> solver;
    };
    std::array<std::unique_ptr<const Submodel>, 2> fillets_;
  };
} // namespace flank
