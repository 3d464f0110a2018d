// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/wedge/face_table.hpp"

#include "contact/wedge/cubic.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/gauss.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace flank::wedge
{
  namespace
  {
    using Axes = TableAxes;

    double radius(const int column)
    {
      return std::exp(Axes::radius_step * (column + Axes::first_radius));
    }

    /// Gauss points from the edge to a distance of 1, graded towards the edge down to half of the least
    /// radius.
    std::vector<std::pair<double, double>> graded_points()
    {
      const GaussRule &rule = gauss(3);
      std::vector<std::pair<double, double>> points;
      for (double high = 1; high > 0;)
        {
          const double low = high > radius(0) ? 0.5 * high : 0;
          for (std::size_t q = 0; q < rule.point.size(); ++q)
            points.emplace_back(low + (high - low) * rule.point[q], rule.weight[q] * (high - low));
          high = low;
        }
      return points;
    }
  } // namespace

  FaceTable::FaceTable(SharedMatrix displacements, SharedMatrix integrals)
      : displacements_(std::move(displacements))
      , integrals_(std::move(integrals))
  {
    FLANK_ASSERT(displacements_.rows() == rows && displacements_.cols() == columns &&
                     integrals_.rows() == rows_of_integrals && integrals_.cols() == columns,
                 "tables of a face");
    mirror();
  }

  FaceTable::FaceTable(const Eigen::MatrixXd &displacements)
      : displacements_(displacements)
  {
    mirror();
    Eigen::MatrixXd integrals(rows_of_integrals, columns);
    const auto across = graded_points();
    const GaussRule &rule = gauss(3);
    for (int i = 0; i < integrals.rows(); ++i)
      {
        double sum = 0, low = 0;
        for (int m = 0; m < integrals.cols(); ++m)
          {
            const double high = radius(m);
            for (std::size_t q = 0; q < rule.point.size(); ++q)
              for (const auto &[distance, weight] : across)
                sum += rule.weight[q] * (high - low) * weight *
                       at(radius(i), low + (high - low) * rule.point[q], distance);
            integrals(i, m) = sum;
            low = high;
          }
      }
    integrals_ = SharedMatrix(std::move(integrals));
  }

  namespace
  {
    /// Where a number lies between a table's logarithms, from the first on.
    double steps_from_first(const double ratio)
    {
      static const double closest = radius(0);
      return std::log(std::max(ratio, closest)) / Axes::radius_step - Axes::first_radius;
    }

    int middle_of_four(const double at, const Eigen::Index count)
    {
      return std::clamp(static_cast<int>(at), 1, static_cast<int>(count) - 3);
    }

    /// Along the edge, over the greater distance from it, where the table ends.
    const double farthest = std::sinh(Axes::along_step * (Axes::n_along - 3));

    template <class Number>
    Number asinh_of_positive(const Number &x)
    {
      using std::log, std::sqrt;
      return log(x + sqrt(1 + x * x));
    }
  } // namespace

  void FaceTable::mirror()
  {
    Eigen::MatrixXd mirrored(rows + 1, columns);
    mirrored << displacements_.row(1), displacements_;
    mirrored_ = SharedMatrix(std::move(mirrored));
  }

  /// By the polynomials through four columns and four rows.
  double FaceTable::between(const int column, const std::array<double, 4> &by_radius, const int row,
                            const std::array<double, 4> &by_along) const
  {
    const double *entry = mirrored_.data() + (column - 1) * mirrored_.rows() + row;
    Eigen::Vector4d of_rows = by_radius[0] * Eigen::Map<const Eigen::Vector4d>(entry);
    for (int p = 1; p < 4; ++p)
      of_rows += by_radius[p] * Eigen::Map<const Eigen::Vector4d>(entry + p * mirrored_.rows());
    return of_rows.dot(Eigen::Map<const Eigen::Vector4d>(by_along.data()));
  }

  double FaceTable::at(const double along, const double place_distance, const double distance) const
  {
    const auto [near, far] = std::minmax(place_distance, distance);
    const double aside = std::abs(along) / far,
                 beyond = std::max(1.0, aside / farthest), // as if both were nearer to the edge
        x = aside / beyond, at_along = asinh_of_positive(x) * (1 / Axes::along_step),
                 at_radius = steps_from_first(near / (far * beyond));
    const int column = middle_of_four(at_radius, columns),
              row = std::min(static_cast<int>(at_along), Axes::n_along - 3);
    return between(column, Cubic(at_radius - column).value, row, Cubic(at_along - row).value) /
           (far * beyond);
  }

  FaceTable::Pack FaceTable::at(const Pack &along, const Pack &place_distance, const Pack &distance) const
  {
    const Pack far = place_distance.max(distance), near = place_distance.min(distance),
               aside = along.abs() / far, beyond = (aside / farthest).max(1.0), x = aside / beyond,
               at_along = asinh_of_positive<Pack>(x) * (1 / Axes::along_step),
               at_radius = (near / (far * beyond)).max(radius(0)).log() * (1 / Axes::radius_step) -
                           Axes::first_radius;
    Pack sum;
    for (int k = 0; k < sum.size(); ++k)
      {
        const int column = middle_of_four(at_radius[k], columns),
                  row = std::min(static_cast<int>(at_along[k]), Axes::n_along - 3);
        sum[k] = between(column, Cubic(at_radius[k] - column).value, row, Cubic(at_along[k] - row).value);
      }
    return sum / (far * beyond);
  }

  double FaceTable::by_places(const int points, const double along, const Strip &first,
                              const Strip &second) const
  {
    const GaussRule &rule = gauss(points);
    const int count = points * points;
    double sum = 0;
    for (int done = 0; done < count; done += 4)
      {
        Pack one, other, weight;
        for (int k = 0; k < 4; ++k)
          {
            const int place = std::min(done + k, count - 1), p = place / points, q = place % points;
            one[k] = first.low + first.length() * rule.point[p];
            other[k] = second.low + second.length() * rule.point[q];
            weight[k] = done + k < count ? rule.weight[p] * rule.weight[q] : 0;
          }
        sum += (weight * at(Pack::Constant(along), one, other)).sum();
      }
    return sum;
  }

  double FaceTable::integral(const double along, const double one, const double other) const
  {
    const auto [near, far] = std::minmax(one, other);
    if (near <= 0)
      return 0;
    if (std::abs(along) > 3.1 * far)
      return near * far * by_places(2, along, { 0, near }, { 0, far });
    static const double closest = radius(0);
    const double at_radius = steps_from_first(near / far), at_along = steps_from_first(std::abs(along) / far),
                 before = std::min(1.0, near / (far * closest)); // proportional to the nearer distance there
    const int m = middle_of_four(at_radius, columns), i = middle_of_four(at_along, rows_of_integrals);
    const Cubic by_radius(at_radius - m), by_along(at_along - i);
    double sum = 0;
    for (int p = 0; p < 4; ++p)
      for (int q = 0; q < 4; ++q)
        sum += by_radius.value[p] * by_along.value[q] * integrals_(i + q - 1, m + p - 1);
    return far * before * sum;
  }

  double FaceTable::mean(const double along, const Strip &first, const Strip &second) const
  {
    // Far from the edge for their size differences of integrals would leave little, most of all of a short
    // strip at the edge and a long one that begins not far from it. (The bounds here and above are none that
    // the strips of a grid meet, where rounding would choose.) Farther, as 1 / (s + d) the mean is the value
    // in the middle within 1/2400 of it, which is some hundredths of what a patch yields under its own load.
    const double lengths = first.length() + second.length();
    if (first.low + second.low > 20.1 * std::max(first.length(), second.length()))
      return at(along, first.middle(), second.middle());
    if (first.low + second.low > 1.1 * lengths || std::abs(along) > 3.1 * std::max(first.high, second.high))
      return by_places(2, along, first, second);
    if (first.low + second.low > 0.55 * lengths)
      return by_places(3, along, first, second);
    return (integral(along, first.high, second.high) - integral(along, first.low, second.high) -
            integral(along, first.high, second.low) + integral(along, first.low, second.low)) /
           (first.length() * second.length());
  }
} // namespace flank::wedge
