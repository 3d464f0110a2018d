// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/rollers/roller_ends.hpp"

#include "contact/wedge/edge_exponent.hpp"
#include "contact/wedge/edge_field.hpp"
#include "contact/wedge/strip_means.hpp"
#include "mesh/base/units.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    constexpr double quarter_space = units::pi / 2;
  }

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

  const wedge::FaceTable &RollerEnds::face_of(const std::size_t roller) const
  {
    std::call_once(once_, [&] {
      const auto of = [](const double poissons_ratio) {
        return wedge::EdgeField(quarter_space, poissons_ratio).face();
      };
      face_[0] = of(poissons_ratio_[0]);
      face_[1] = poissons_ratio_[0] == poissons_ratio_[1] ? face_[0] : of(poissons_ratio_[1]);
    });
    return face_[roller];
  }

  std::vector<Eigen::MatrixXd> RollerEnds::between(const Cells &cells) const
  {
    const auto strip = [&](const double half_length, const int row, const int side) {
      const double middle = half_length - side * (2 * row + 1) * cells.half_along;
      return wedge::Strip{ std::max(0.0, middle - cells.half_along), middle + cells.half_along };
    };
    std::vector<Eigen::MatrixXd> result(static_cast<std::size_t>(cells.rows),
                                        Eigen::MatrixXd::Zero(cells.columns, 2 * cells.rows));
    for (int row = 0; row < cells.rows; ++row)
      for (int other = -cells.rows; other < cells.rows; ++other)
        for (std::size_t roller = 0; roller < 2; ++roller)
          for (const int side : { -1, 1 })
            {
              const double half = half_length_[roller];
              wedge::StripMeans means(face_of(roller), strip(half, row, side), strip(half, other, side));
              for (int i = 0; i < cells.columns; ++i)
                result[static_cast<std::size_t>(row)](i, other + cells.rows) +=
                    compliance_[roller] *
                    means.mean(2 * i * cells.half_across, cells.half_across, cells.half_across);
            }
    return result;
  }
} // namespace flank
