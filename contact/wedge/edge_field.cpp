// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/wedge/edge_field.hpp"

#include "contact/wedge/cubic.hpp"
#include "contact/wedge/section_waves.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/gauss.hpp"
#include "mesh/base/units.hpp"
#include "solver/elements/elastic_body.hpp"
#include "solver/elements/lagrange.hpp"

#include <array>
#include <cmath>

namespace flank::wedge
{
  namespace
  {
    using Axes = TableAxes;
    constexpr double step = Axes::radius_step; ///< of wave numbers and distances too

    /// Wave numbers times the load's distance: exp(step k) for k from first to last.
    constexpr int first_wave = -76,
                  last_wave = 26; // 7.5e-5 to 26: beyond, waves die out before they come back

    constexpr int n_radii = Axes::last_radius - Axes::first_radius + 1;

    /// A smooth end of the waves for far places: waves shorter than 1/60 of the place's distance do not
    /// matter there.
    constexpr double window = 60;

    /// Lagrange's polynomials through the six points -2 to 3.
    std::array<double, 6> quintic(const double t)
    {
      std::array<double, 6> weight{};
      for (int i = 0; i < 6; ++i)
        {
          weight[i] = 1;
          for (int j = 0; j < 6; ++j)
            if (j != i)
              weight[i] *= (t - (j - 2)) / (i - j);
        }
      return weight;
    }

    /// How the amplitudes of the waves, known at exp(step k), add up to a displacement at a place along the
    /// edge: 1/pi times the integral of cos(k x), or of sin(k x) for what is odd, times the amplitude.
    struct SumOfWaves
    {
      Eigen::VectorXd even = Eigen::VectorXd::Zero(last_wave - first_wave + 1), odd = even;
    };

    SumOfWaves sum_of_waves(const double x)
    {
      SumOfWaves sum;
      const auto add = [&](const double k, const double weight) {
        const double at = std::log(k) / step - first_wave;
        const int low = std::clamp(static_cast<int>(at), 2, last_wave - first_wave - 3);
        const auto by = quintic(at - low);
        const double fading = k * x > 3 ? std::exp(-std::pow((k * x - 3) / window, 2)) : 1;
        for (int i = 0; i < 6; ++i)
          {
            sum.even[low - 2 + i] += weight * fading * std::cos(k * x) * by[i] / units::pi;
            sum.odd[low - 2 + i] += weight * fading * std::sin(k * x) * by[i] / units::pi;
          }
      };
      const GaussRule &rule = gauss(6);
      const double least = std::exp(step * first_wave), greatest = std::exp(step * last_wave);
      double k = least;
      for (bool more = true; more && k * x < 3 + 4 * window;)
        {
          const double wanted = x > 0 ? std::min(0.5 * step * k, 1 / x) : 0.5 * step * k;
          more = k + wanted < greatest;
          const double length = more ? wanted : greatest - k;
          for (std::size_t q = 0; q < rule.point.size(); ++q)
            add(k + length * rule.point[q], length * rule.weight[q]);
          k += length;
        }
      // Below the least wave number the even amplitudes go as a + b log(k): the body's rigid shift.
      sum.even[0] += least / units::pi * (1 + 1 / step);
      sum.even[1] -= least / units::pi / step;
      return sum;
    }
  } // namespace

  EdgeField::EdgeField(const double opening, const double poissons_ratio)
      : opening_(opening)
      , n_angles_(0)
  {
    FLANK_ASSERT(opening > 0.5 && opening < 3.15, "a wedge of 30 to 180 degrees");
    const SectionWaves section(opening, poissons_ratio);
    n_angles_ = section.angles();
    const int n_waves = last_wave - first_wave + 1;
    // With the wave number as the unit, the load of wave k stands at k and a radius r lies at k r.
    const auto logs = [](const int first, const int last) {
      return Eigen::VectorXd::LinSpaced(last - first + 1, step * first, step * last).eval();
    };
    const Eigen::MatrixXd waves = section.response(
        logs(first_wave, last_wave), logs(first_wave + Axes::first_radius, last_wave + Axes::last_radius));
    std::vector<SumOfWaves> sums;
    for (int i = 0; i < Axes::n_along; ++i)
      sums.push_back(sum_of_waves(std::sinh(Axes::along_step * i)));
    const Eigen::Index size = 3 * n_angles_;
    table_.resize(size, static_cast<Eigen::Index>(n_radii) * Axes::n_along);
    Eigen::MatrixXd at_radius(size, n_waves);
    for (int m = 0; m < n_radii; ++m)
      {
        for (int k = 0; k < n_waves; ++k)
          at_radius.col(k) = waves.col(k).segment(size * (m + k), size);
        for (int i = 0; i < Axes::n_along; ++i)
          {
            const Eigen::VectorXd even = at_radius * sums[i].even, odd = at_radius * sums[i].odd;
            for (int a = 0; a < n_angles_; ++a)
              table_.col(m * Axes::n_along + i).segment<3>(3 * a) << odd[3 * a], even[3 * a + 1],
                  even[3 * a + 2];
          }
      }
  }

  /// A place in the table's coordinates, and how a value from it is scaled.
  struct EdgeField::Place
  {
    double log_radius, angle, along; ///< in steps; in elements; in steps, never negative
    bool mirrored;                   ///< at the other side of the load along the edge
    double radius, x;                ///< over the load's distance
    double scale;                    ///< of a value [1/mm]
    double far;                      ///< by what the place was drawn in
  };

  EdgeField::Place EdgeField::place_of(const Eigen::Vector3d &place, const double distance) const
  {
    Place result{};
    static const double closest = std::exp(step * Axes::first_radius),
                        farthest_radius = std::exp(step * (Axes::last_radius - 1)),
                        farthest_along = std::sinh(Axes::along_step * (Axes::n_along - 3));
    double r = std::sqrt(place.y() * place.y() + place.z() * place.z()) / distance,
           x = std::abs(place.x()) / distance;
    // Far from the load as near the edge: the field is one over the distance there.
    result.far = std::max({ 1.0, r / farthest_radius, x / farthest_along });
    r = std::max(r / result.far, closest);
    x /= result.far;
    result.radius = r;
    result.x = x;
    result.scale = 1 / (distance * result.far);
    result.log_radius = std::log(r) / step - Axes::first_radius;
    result.along = std::log(x + std::sqrt(1 + x * x)) / Axes::along_step;
    result.mirrored = place.x() < 0;
    const double angle = std::clamp(std::atan2(place.z(), place.y()), 0.0, opening_);
    result.angle = angle / opening_ * elements_across();
    return result;
  }

  namespace
  {
    using OfElement = Eigen::Matrix<double, 12, 1>; ///< displacements of the four nodes across an element
    using Across = Eigen::Matrix<double, 3, 4>;     ///< the same, a column a node

    /// Calls use(p, q, nodes) for the columns (radius, place along the edge) about m and i, of an element's
    /// rows. Beside the load the component along the edge is odd, the others are even.
    template <class Use>
    void each_about(const Eigen::MatrixXd &table, const Eigen::Index row, const int m, const int i,
                    const Use &use)
    {
      for (int p = 0; p < 4; ++p)
        {
          const double *of_radius =
              &table.coeffRef(row, static_cast<Eigen::Index>(m + p - 1) * TableAxes::n_along);
          for (int q = i > 0 ? 0 : 1; q < 4; ++q)
            use(p, q, Eigen::Map<const OfElement>(of_radius + (i + q - 1) * table.rows()));
          if (i == 0)
            {
              OfElement mirrored = Eigen::Map<const OfElement>(of_radius + table.rows());
              for (int a = 0; a < 4; ++a)
                mirrored[3 * a] = -mirrored[3 * a];
              use(p, 0, mirrored);
            }
        }
    }

    const LagrangePolynomials &across_elements()
    {
      static const LagrangePolynomials shape(lobatto_abscissas(3));
      return shape;
    }
  } // namespace

  /// What a place lies between in the table.
  struct EdgeField::Cell
  {
    int element, m, i;
    Cubic by_radius, by_along;
  };

  EdgeField::Cell EdgeField::cell_of(const Place &place) const
  {
    const int element = std::min(static_cast<int>(place.angle), elements_across() - 1),
              m = std::clamp(static_cast<int>(place.log_radius), 1, n_radii - 3),
              i = std::min(static_cast<int>(place.along), Axes::n_along - 3);
    return { element, m, i, Cubic(place.log_radius - m), Cubic(place.along - i) };
  }

  Eigen::Vector3d EdgeField::displacement(const Eigen::Vector3d &place, const double distance) const
  {
    const Place at = place_of(place, distance);
    const Cell cell = cell_of(at);
    OfElement nodes = OfElement::Zero();
    each_about(table_, 9 * cell.element, cell.m, cell.i, [&](const int p, const int q, const auto &here) {
      nodes += cell.by_radius.value[p] * cell.by_along.value[q] * here;
    });
    const auto across = across_elements().values(at.angle - cell.element);
    Eigen::Vector3d result = at.scale * (Eigen::Map<const Across>(nodes.data()) *
                                         Eigen::Map<const Eigen::Vector4d>(across.data()));
    if (at.mirrored)
      result.x() = -result.x();
    return result;
  }

  Eigen::Matrix3d EdgeField::gradient(const Eigen::Vector3d &place, const double distance) const
  {
    const Place at = place_of(place, distance);
    const Cell cell = cell_of(at);
    const auto across = across_elements().with_derivatives(at.angle - cell.element);
    const Cubic &radius = cell.by_radius, &along = cell.by_along;
    OfElement value = OfElement::Zero(), of_radius = value, of_along = value;
    each_about(table_, 9 * cell.element, cell.m, cell.i, [&](const int p, const int q, const auto &here) {
      value += radius.value[p] * along.value[q] * here;
      of_radius += radius.derivative[p] * along.value[q] * here;
      of_along += radius.value[p] * along.derivative[q] * here;
    });
    const auto sum = [&](const OfElement &nodes,
                         const LagrangePolynomials::Values &weights) -> Eigen::Vector3d {
      Eigen::Vector3d result =
          Eigen::Map<const Across>(nodes.data()) * Eigen::Map<const Eigen::Vector4d>(weights.data());
      if (at.mirrored)
        result.x() = -result.x();
      return result;
    };
    const double angle = at.angle * opening_ / elements_across(), c = std::cos(angle), s = std::sin(angle);
    const Eigen::Vector3d by_x = (at.mirrored ? -1 : 1) / (Axes::along_step * std::hypot(1.0, at.x)) *
                                 sum(of_along, across.value),
                          by_r = sum(of_radius, across.value) / (step * at.radius),
                          by_angle =
                              sum(value, across.derivative) * (elements_across() / opening_ / at.radius);
    Eigen::Matrix3d result;
    result << by_x, c * by_r - s * by_angle, s * by_r + c * by_angle;
    return at.scale / (distance * at.far) * result;
  }

  FaceTable EdgeField::face() const
  {
    Eigen::MatrixXd displacements(Axes::n_along, FaceTable::columns);
    for (Eigen::Index m = 0; m < displacements.cols(); ++m)
      for (Eigen::Index i = 0; i < displacements.rows(); ++i)
        displacements(i, m) = table_(2, m * Axes::n_along + i);
    return FaceTable(displacements);
  }
} // namespace flank::wedge
