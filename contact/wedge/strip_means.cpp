// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/wedge/strip_means.hpp"

#include "mesh/base/gauss.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace flank::wedge
{
  namespace
  {
    constexpr std::size_t most_pieces = 8; ///< on either side of a peak, each four times as long as the last

    double length_of(const std::size_t interval)
    {
      return interval == 0 ? 1 : std::ldexp(1.0, static_cast<int>(interval) - 1);
    }

    double low_end(const std::size_t interval)
    {
      return interval == 0 ? 0 : length_of(interval);
    }
  } // namespace

  StripMeans::StripMeans(const FaceTable &table, const Strip &first, const Strip &second, const bool as_lines)
      : table_(&table)
      , first_(first)
      , second_(second)
      , as_lines_(as_lines)
      , smooth_(first.low + second.low > 0.26 * (first.length() + second.length()))
      , scale_(smooth_ ? 0.7 * (first.low + second.low) : 0.05 * std::max(first.high, second.high))
      , intervals_(smooth_ ? 2 : most_intervals)
  {
    for (Coefficients &coefficients : coefficient_)
      coefficients.back() = std::numeric_limits<double>::quiet_NaN();
  }

  StripMeans::Coefficients StripMeans::tabulated(const std::size_t interval) const
  {
    // From values at 0, 1/4, 1/2, 3/4, 1 to the coefficients of powers.
    constexpr double to_powers[points][points] = { { 3, 0, 0, 0, 0 },
                                                   { -25, 48, -36, 16, -3 },
                                                   { 70, -208, 228, -112, 22 },
                                                   { -80, 288, -384, 224, -48 },
                                                   { 32, -128, 192, -128, 32 } };
    Coefficients value, result;
    for (int i = 0; i < points; ++i)
      {
        const double t = static_cast<double>(i) / (points - 1),
                     place = interval == 0 && smooth_ ? std::sqrt(t) : t;
        value[i] = table_->mean(scale_ * (low_end(interval) + length_of(interval) * place), first_, second_);
      }
    for (int i = 0; i < points; ++i)
      {
        double sum = 0;
        for (int j = 0; j < points; ++j)
          sum += to_powers[i][j] * value[j];
        result[i] = sum / 3;
      }
    return result;
  }

  double StripMeans::at(const double along)
  {
    if (as_lines_)
      return table_->at(along, first_.middle(), second_.middle());
    const double x = std::abs(along) / scale_;
    int exponent = 0;
    if (x >= 1)
      std::frexp(x, &exponent); // x = m 2^exponent, 1/2 <= m < 1
    const auto interval = static_cast<std::size_t>(exponent);
    if (interval >= intervals_)
      return table_->mean(along, first_, second_);
    const double place = (x - low_end(interval)) / length_of(interval),
                 t = interval == 0 && smooth_ ? place * place : place;
    Coefficients &c = coefficient_[interval];
    if (std::isnan(c.back()))
      c = tabulated(interval);
    return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * c[4])));
  }

  /// Over places along the edge, each with its weight.
  double StripMeans::sum(const std::span<const std::pair<double, double>> places)
  {
    using Pack = FaceTable::Pack;
    double result = 0;
    if (!as_lines_)
      {
        for (const auto &[place, weight] : places)
          result += weight * at(place);
        return result;
      }
    for (std::size_t done = 0; done < places.size(); done += 4)
      {
        Pack along = Pack::Constant(places.back().first), weight = Pack::Zero();
        for (std::size_t k = 0; k < 4 && done + k < places.size(); ++k)
          std::tie(along[static_cast<int>(k)], weight[static_cast<int>(k)]) = places[done + k];
        result +=
            (weight * table_->at(along, Pack::Constant(first_.middle()), Pack::Constant(second_.middle())))
                .sum();
      }
    return result;
  }

  double StripMeans::mean(const double along, const double a, const double b)
  {
    const double x = std::abs(along), most = a + b, flat = std::abs(a - b);
    // Bounds that the cells of a grid do not meet, where rounding would choose.
    if (8.1 * most < first_.low + second_.low) // what is left out is 1/200 of it at most
      return at(x);
    if (x > 2.1 * most || 4.1 * most < first_.low + second_.low)
      { // As the second moment of both lengths says.
        const double aside = std::sqrt((a * a + b * b) / 3);
        return 0.5 * (at(x - aside) + at(x + aside));
      }
    // Two places of the rectangles are t beside their middles' distance as often as the height of a trapezoid
    // at t says. Pieces between its corners, and from where places lie beside each other on: there the
    // function has a peak as wide as the strips lie from the edge, however much wider the rectangles are.
    constexpr std::size_t most_corners = 5 + 2 * most_pieces, points_of_piece = 3;
    std::array<std::pair<double, double>, most_corners * points_of_piece> places;
    auto last = places.begin();
    std::array<double, most_corners> corners = { -most, -flat, flat, most, std::clamp(-x, -most, most) };
    auto end = corners.begin() + 5;
    double from = 0.5 * (first_.high + first_.low + second_.high + second_.low);
    for (; from < x + most && end != corners.end(); from *= 4)
      for (const double t : { -x - from, -x + from })
        *end++ = std::clamp(t, -most, most);
    std::sort(corners.begin(), end);
    const GaussRule &rule = gauss(points_of_piece);
    for (auto corner = corners.begin(); corner + 1 != end; ++corner)
      if (const double length = corner[1] - corner[0]; length > 0)
        for (std::size_t q = 0; q < rule.point.size(); ++q)
          {
            const double t = corner[0] + length * rule.point[q],
                         height = std::min(2 * std::min(a, b), most - std::abs(t));
            *last++ = { x + t, rule.weight[q] * length * height };
          }
    return sum({ places.begin(), last }) / (4 * a * b);
  }
} // namespace flank::wedge
