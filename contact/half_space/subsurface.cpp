// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/half_space/subsurface.hpp"

#include "mesh/base/least.hpp"

#include <Eigen/Eigenvalues>

namespace flank::half_space
{
  double von_mises(const Eigen::Matrix3d &stress)
  {
    return std::sqrt(1.5) * (stress - stress.trace() / 3 * Eigen::Matrix3d::Identity()).norm();
  }

  StressBelow stress_below(const std::vector<LoadedRectangle> &loads, const double nu)
  {
    return [&loads, nu](const Eigen::Vector2d &at, const double depth) {
      Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
      for (const LoadedRectangle &load : loads)
        sum += load.force * love_stress(load.area.a, load.area.b,
                                        { at.x() - load.area.x, at.y() - load.area.y, depth }, nu);
      return sum;
    };
  }

  SubsurfaceStress greatest_below(const std::vector<LoadedRectangle> &loads,
                                  const std::vector<Eigen::Vector2d> &points, const double deepest,
                                  const double nu, const int samples)
  {
    return greatest_below(stress_below(loads, nu), points, deepest, samples);
  }

  SubsurfaceStress greatest_below(const StressBelow &stress, const std::vector<Eigen::Vector2d> &points,
                                  const double deepest, const int samples)
  {
    const auto shear = [](const Eigen::Matrix3d &s) {
      const Eigen::Vector3d principal =
          Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(s, Eigen::EigenvaluesOnly).eigenvalues();
      return (principal[2] - principal[0]) / 2;
    };
    struct Best
    {
      double value = 0, depth = 0;
      Eigen::Vector2d at = Eigen::Vector2d::Zero();
    };
    Best of_shear, of_von_mises;
    const auto keep = [](Best &best, const double value, const double depth, const Eigen::Vector2d &at) {
      if (value > best.value)
        best = { value, depth, at };
    };
    for (const Eigen::Vector2d &at : points)
      for (int k = 0; k <= samples; ++k)
        {
          const double depth = deepest * k / samples;
          const Eigen::Matrix3d s = stress(at, depth);
          keep(of_shear, shear(s), depth, at);
          keep(of_von_mises, von_mises(s), depth, at);
        }
    const auto refine = [&](Best &best, const auto &measure) {
      const double step = deepest / samples;
      const auto at = least_between([&](const double depth) { return -measure(stress(best.at, depth)); },
                                    std::max(0.0, best.depth - step), best.depth + step, 16);
      if (-at.second > best.value)
        best.value = -at.second, best.depth = at.first;
    };
    refine(of_shear, shear);
    refine(of_von_mises, von_mises);
    return { of_shear.value, of_shear.depth, of_von_mises.value, of_von_mises.depth };
  }

  SubsurfaceStress greatest_below_both(const std::vector<LoadedRectangle> &loads,
                                       const std::vector<Eigen::Vector2d> &points, const double deepest,
                                       const double first_nu, const double second_nu)
  {
    const SubsurfaceStress first = greatest_below(loads, points, deepest, first_nu);
    return second_nu == first_nu ? first
                                 : greater_of(first, greatest_below(loads, points, deepest, second_nu));
  }

  SubsurfaceStress greater_of(const SubsurfaceStress &one, const SubsurfaceStress &other)
  {
    SubsurfaceStress result = one;
    if (other.shear > result.shear)
      result.shear = other.shear, result.shear_depth = other.shear_depth;
    if (other.von_mises > result.von_mises)
      result.von_mises = other.von_mises, result.von_mises_depth = other.von_mises_depth;
    return result;
  }
} // namespace flank::half_space
