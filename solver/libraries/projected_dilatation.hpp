// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/base/errors.hpp"

#include <deal.II/fe/fe_values.h>

#include <Eigen/Dense>

#include <cmath>
#include <vector>

namespace flank
{
  /// The least-squares projection of a cell's dilatation div u on the polynomials of total degree below the
  /// element's, in x, y and z. Where materials hardly change their volume, elements whose every quadrature
  /// point must keep it are too stiff ("locking"); with these few means the displacement converges as fast as
  /// for any other material (Q_k with discontinuous P_(k-1) pressures, stable for k >= 2; of degree 1 the
  /// displacements alone: Boffi, Brezzi and Fortin 2013, ch. 8; polynomials of x, y, z and not of reference
  /// coordinates: Arnold, Boffi and Falk 2002).
  class ProjectedDilatation
  {
  public:
    explicit ProjectedDilatation(int degree)
        : degree_(degree)
    {
    }

    /// The projection of a cell. `values`: gradients, Jacobians, points and weights at its quadrature
    /// points; lexicographic: local index of the i-th node.
    void reinit(const dealii::FEValues<3> &values, const std::vector<unsigned int> &lexicographic)
    {
      place(values);
      const auto n = static_cast<Eigen::Index>(lexicographic.size());
      Eigen::MatrixXd mass;
      for (const unsigned int q : values.quadrature_point_indices())
        {
          const Eigen::VectorXd p = polynomials(values.quadrature_point(q));
          if (q == 0)
            {
              mass.setZero(p.size(), p.size());
              moments_.setZero(p.size(), 3 * n);
            }
          Eigen::RowVectorXd dilatation(3 * n);
          for (Eigen::Index i = 0; i < n; ++i)
            for (int c = 0; c < 3; ++c)
              dilatation[3 * i + c] = values.shape_grad(lexicographic[i], q)[c];
          mass += values.JxW(q) * p * p.transpose();
          moments_ += values.JxW(q) * p * dilatation;
        }
      mass_.compute(mass);
      FLANK_ASSERT(mass_.info() == Eigen::Success, "polynomials of a cell are independent");
    }

    /// Integral of the square of the projection over the cell, as a form of the nodes' displacements. [mm]
    Eigen::MatrixXd square() const { return moments_.transpose() * mass_.solve(moments_); }

    /// The projection at a point of the cell, per displacement of the nodes. [1/mm]
    Eigen::VectorXd at(const dealii::Point<3> &x) const
    {
      return moments_.transpose() * mass_.solve(polynomials(x));
    }

  private:
    /// Middle and mean axes of the cell, in which its polynomials are of order one however slender it is.
    void place(const dealii::FEValues<3> &values)
    {
      middle_.setZero();
      Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
      for (const unsigned int q : values.quadrature_point_indices())
        for (int i = 0; i < 3; ++i)
          {
            middle_[i] += values.quadrature_point(q)[i] / values.n_quadrature_points;
            for (int j = 0; j < 3; ++j)
              axes(i, j) += values.jacobian(q)[i][j] / values.n_quadrature_points;
          }
      to_axes_ = axes.inverse();
    }

    Eigen::VectorXd polynomials(const dealii::Point<3> &x) const
    {
      std::vector<double> values;
      const Eigen::Vector3d y = 2 * to_axes_ * (Eigen::Vector3d(x[0], x[1], x[2]) - middle_);
      for (int i = 0; i < degree_; ++i)
        for (int j = 0; i + j < degree_; ++j)
          for (int k = 0; i + j + k < degree_; ++k)
            values.push_back(std::pow(y[0], i) * std::pow(y[1], j) * std::pow(y[2], k));
      return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
    }

    int degree_;
    Eigen::Vector3d middle_;  ///< [mm]
    Eigen::Matrix3d to_axes_; ///< [1/mm]
    Eigen::MatrixXd moments_; ///< of the nodes' dilatation with the polynomials
    Eigen::LLT<Eigen::MatrixXd> mass_;
  };
} // namespace flank
