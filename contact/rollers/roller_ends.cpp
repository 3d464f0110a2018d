// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/rollers/roller_ends.hpp"

#include "contact/wedge/edge_exponent.hpp"
#include "contact/wedge/edge_field.hpp"
#include "contact/wedge/strip_means.hpp"
#include "mesh/base/units.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

namespace flank
{
  namespace
  {
    constexpr double quarter_space = units::pi / 2;

    /// The face of a quarter-space, made when it is first asked for: one for all variants of a study.
    const wedge::FaceTable &face_of(const double poissons_ratio)
    {
      static std::mutex mutex;
      static std::map<double, wedge::FaceTable> faces;
      const std::lock_guard lock(mutex);
      auto face = faces.find(poissons_ratio);
      if (face == faces.end())
        face = faces.emplace(poissons_ratio, wedge::EdgeField(quarter_space, poissons_ratio).face()).first;
      return face->second;
    }
  } // namespace

  RollerEnds::RollerEnds(const CrownedRoller &first, const CrownedRoller &second)
      : half_length_{ first.length / 2, second.length / 2 }
      , compliance_{ 1 / first.youngs_modulus, 1 / second.youngs_modulus }
      , poissons_ratio_{ first.poissons_ratio, second.poissons_ratio }
  {
    const auto end = [&](const CrownedRoller &roller) {
      const bool ends_there = roller.length <= std::min(first.length, second.length) * (1 + 1e-9);
      return wedge::EndOfContact{ ends_there ? quarter_space : units::pi,
                                  roller.youngs_modulus / (1 - std::pow(roller.poissons_ratio, 2)) };
    };
    exponent_ = wedge::pressure_exponent(end(first), end(second));
  }

  Eigen::VectorXd RollerEnds::between(const Faces &faces, const Cells &cells, const int row,
                                      const int other) const
  {
    // Row -1 - k is the image of row k in the other half.
    const auto strip = [&](const double half_length, const int k, const int side) {
      const bool is_image = k < 0;
      const auto index = static_cast<std::size_t>(is_image ? -1 - k : k);
      const double low = is_image ? -cells.borders[index + 1] : cells.borders[index],
                   high = is_image ? -cells.borders[index] : cells.borders[index + 1];
      return side > 0 ? wedge::Strip{ std::max(0.0, half_length - high), half_length - low }
                      : wedge::Strip{ std::max(0.0, half_length + low), half_length + high };
    };
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(cells.columns);
    for (std::size_t roller = 0; roller < 2; ++roller)
      for (const int side : { -1, 1 })
        {
          const double half = half_length_[roller];
          wedge::StripMeans means(*faces[roller], strip(half, row, side), strip(half, other, side));
          for (int i = 0; i < cells.columns; ++i)
            sum[i] += compliance_[roller] *
                      means.mean(2 * i * cells.half_across, cells.half_across, cells.half_across);
        }
    return sum;
  }

  std::vector<Eigen::MatrixXd> RollerEnds::between(const Cells &cells) const
  {
    const int rows = cells.rows();
    const Faces faces = { &face_of(poissons_ratio_[0]), &face_of(poissons_ratio_[1]) };
    std::vector<Eigen::MatrixXd> result(static_cast<std::size_t>(rows),
                                        Eigen::MatrixXd::Zero(cells.columns, 2 * rows));
    for (int row = 0; row < rows; ++row)
      for (int other = row; other < rows; ++other)
        for (const bool is_image : { false, true })
          {
            const auto column = [&](const int k) { return is_image ? rows - 1 - k : rows + k; };
            const Eigen::VectorXd added = between(faces, cells, row, is_image ? -1 - other : other);
            result[static_cast<std::size_t>(row)].col(column(other)) = added;
            result[static_cast<std::size_t>(other)].col(column(row)) = added;
          }
    return result;
  }
} // namespace flank
