// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/rollers/roller_ends.hpp"

#include "contact/wedge/edge_exponent.hpp"
#include "contact/wedge/edge_field.hpp"
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

  const std::array<std::shared_ptr<const wedge::FaceMeans>, 2> &RollerEnds::means() const
  {
    std::call_once(once_, [&] {
      const auto of = [](const double poissons_ratio) {
        return std::make_shared<const wedge::FaceMeans>(
            wedge::EdgeField(quarter_space, poissons_ratio).face());
      };
      means_[0] = of(poissons_ratio_[0]);
      means_[1] = poissons_ratio_[0] == poissons_ratio_[1] ? means_[0] : of(poissons_ratio_[1]);
    });
    return means_;
  }

  RollerEnds::Rows::Rows(const RollerEnds &ends, const double place, const double other,
                         const double half_along)
      : compliance_(ends.compliance_)
  {
    for (std::size_t roller = 0; roller < 2; ++roller)
      for (const int side : { 0, 1 })
        {
          // Grids repeat from force to force, but for rounding.
          const double half = ends.half_length_[roller], rounding = 1e-9 * half;
          const auto strip = [&](const double at) {
            const double middle = side == 0 ? half - at : half + at;
            const auto rounded = [&](const double d) {
              return std::max(0.0, rounding * std::round(d / rounding));
            };
            return wedge::FaceMeans::Strip{ rounded(middle - half_along), rounded(middle + half_along) };
          };
          means_[2 * roller + static_cast<std::size_t>(side)] =
              &ends.means()[roller]->between(strip(place), strip(other));
        }
  }

  double RollerEnds::Rows::between(const double across, const double half_across) const
  {
    double sum = 0;
    for (std::size_t k = 0; k < means_.size(); ++k)
      sum += compliance_[k / 2] * means_[k]->mean(across, half_across, half_across);
    return sum;
  }
} // namespace flank
