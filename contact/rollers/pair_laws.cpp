// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/rollers/pair_laws.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    constexpr double ladder_ratio = 1.1; ///< of neighbouring relative radii, in roller radii
  }                                      // namespace

  PairLaws::PairLaws(const RollerContactData &contact, const RollerGridSize &grid)
      : contact_(contact)
      , grid_(grid)
      , circle_(std::make_unique<PairLaw>(contact, grid))
  {
  }

  const PairLaw &PairLaws::rung(const int index) const
  {
    const std::lock_guard lock(mutex_);
    auto &law = ladder_[index];
    if (!law)
      {
        RollerContactData contact = contact_;
        contact.sleeve_radius = contact.roller_radius / (std::pow(ladder_ratio, -index) - 1);
        law = std::make_unique<PairLaw>(contact, grid_);
      }
    return *law;
  }

  PairState PairLaws::at_approach(const double sleeve_radius, const double approach) const
  {
    if (sleeve_radius == contact_.sleeve_radius)
      return circle_->at_approach(approach);
    const double place = -std::log(1 + contact_.roller_radius / sleeve_radius) / std::log(ladder_ratio);
    const int index = static_cast<int>(std::floor(place));
    const double t = place - index;
    const auto a = rung(index).at_approach(approach), b = rung(index + 1).at_approach(approach);
    const auto mix = [&](const double x, const double y) {
      return x > 0 && y > 0 ? x * std::pow(y / x, t) : x + t * (y - x);
    };
    const double force = mix(a.force, b.force);
    const bool by_logarithms = a.force > 0 && b.force > 0; // as mix() has it
    return { .force = force,
             .approach = approach,
             .stiffness = by_logarithms
                              ? force * ((1 - t) * a.stiffness / a.force + t * b.stiffness / b.force)
                              : (1 - t) * a.stiffness + t * b.stiffness,
             .mid_pressure = mix(a.mid_pressure, b.mid_pressure),
             .edge_pressure = mix(a.edge_pressure, b.edge_pressure),
             .max_pressure = mix(a.max_pressure, b.max_pressure),
             .certificate = std::max(a.certificate, b.certificate) };
  }

  PairState PairLaws::load_at(const double sleeve_radius, const double approach) const
  {
    return sleeve_radius == contact_.sleeve_radius ? circle_->load_at(approach)
                                                   : at_approach(sleeve_radius, approach);
  }

  PressureMap PairLaws::map(const double sleeve_radius, const double force) const
  {
    RollerContactData contact = contact_;
    contact.sleeve_radius = sleeve_radius;
    return PairLaw(contact, grid_).map(force);
  }
} // namespace flank
