// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/rollers/support_balance.hpp"

#include "mesh/base/errors.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  SupportBalance::SupportBalance(const DriveSupports &supports, const int sleeves)
      : sleeves_(sleeves)
  {
    for (const auto &[part, law] : supports.elastic)
      {
        const int count = is_of_sleeve(part) ? sleeves : 1;
        supports_.push_back({ part, &law, size_, count });
        size_ += 2 * count;
      }
  }

  std::vector<Eigen::Vector2d> SupportBalance::shift(const SupportState &state) const
  {
    std::vector<Eigen::Vector2d> result;
    for (int n = 1; state.place.size() > 0 && n <= sleeves_; ++n)
      {
        Eigen::Vector2d &of_sleeve = result.emplace_back(Eigen::Vector2d::Zero());
        for (const Support &support : supports_)
          of_sleeve += state.place.segment<2>(support.place(n));
      }
    return result;
  }

  Eigen::Vector2d SupportBalance::displacement(const SupportState &state, const SupportPart part,
                                               const int sleeve) const
  {
    for (const Support &support : supports_)
      if (support.part == part && state.place.size() > 0)
        return state.place.segment<2>(support.place(sleeve));
    return Eigen::Vector2d::Zero();
  }

  void SupportBalance::add(const int sleeve, const Eigen::Vector2d &force, Eigen::VectorXd &on_supports) const
  {
    for (const Support &support : supports_)
      on_supports.segment<2>(support.place(sleeve)) += force;
  }

  Eigen::MatrixXd SupportBalance::stiffness(const SupportState &state,
                                            const std::vector<SupportedContact> &contacts) const
  {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size_, size_);
    for (const Support &support : supports_)
      for (int at = support.first; at < support.first + 2 * support.count; at += 2)
        sum.block<2, 2>(at, at) += support.law->tangent(state.place.segment<2>(at));
    for (const SupportedContact &c : contacts)
      {
        const Eigen::Matrix2d along = c.normal * c.normal.transpose(),
                              of_contact = c.stiffness * along -
                                           c.force / c.distance * (Eigen::Matrix2d::Identity() - along);
        for (const Support &one : supports_)
          for (const Support &other : supports_)
            sum.block<2, 2>(one.place(c.sleeve), other.place(c.sleeve)) += of_contact;
      }
    return sum;
  }

  /// Torque that the pairs do not carry, over the radius, then forces of the supports less those on them. [N]
  Eigen::VectorXd SupportBalance::residual(const SupportState &state,
                                           const std::vector<SupportedContact> &contacts, const double torque,
                                           const double radius) const
  {
    Eigen::VectorXd on_supports = Eigen::VectorXd::Zero(size_), result(size_ + 1);
    double carried = 0;
    for (const SupportedContact &c : contacts)
      {
        carried += c.lever * c.force;
        add(c.sleeve, c.force * c.normal, on_supports);
      }
    result[0] = (torque - carried) / radius;
    result.tail(size_) = -on_supports;
    for (const Support &support : supports_)
      for (int at = support.first; at < support.first + 2 * support.count; at += 2)
        result.segment<2>(1 + at) += support.law->force(state.place.segment<2>(at));
    return result;
  }

  Eigen::VectorXd SupportBalance::step(const SupportState &state,
                                       const std::vector<SupportedContact> &contacts,
                                       const Eigen::VectorXd &residual, const double radius,
                                       const double damping, const double usual_stiffness) const
  {
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(size_ + 1, size_ + 1);
    system.bottomRightCorner(size_, size_) = stiffness(state, contacts);
    for (const SupportedContact &c : contacts)
      {
        const double by_turning = c.stiffness * c.lever / radius;
        Eigen::VectorXd on_supports = Eigen::VectorXd::Zero(size_);
        add(c.sleeve, by_turning * c.normal, on_supports);
        system(0, 0) += by_turning * c.lever / radius;
        system.col(0).tail(size_) += on_supports;
        system.row(0).tail(size_) += on_supports.transpose();
      }
    system.diagonal().array() += damping * system.diagonal().array().abs().max(usual_stiffness);
    const Eigen::VectorXd whole = -Eigen::PartialPivLU<Eigen::MatrixXd>(system).solve(residual);
    const double longest = 0.01 * radius; // where nothing is pressed nothing else bounds it
    return whole * std::min(1.0, longest / whole.norm());
  }

  SupportState SupportBalance::moved(const SupportState &state, const Eigen::VectorXd &step,
                                     const double radius) const
  {
    SupportState result = state;
    result.psi += step[0] / radius;
    result.place += step.tail(size_);
    return result;
  }

  namespace
  {
    double greatest_force(const std::vector<SupportedContact> &contacts)
    {
      double greatest = 0;
      for (const SupportedContact &c : contacts)
        greatest = std::max(greatest, c.force);
      return greatest;
    }
  } // namespace

  /// A place on the way to equilibrium.
  struct SupportBalance::Place
  {
    SupportState state;
    std::vector<SupportedContact> pressed;
    Eigen::VectorXd left; ///< residual: the gradient of the energy
  };

  /// The place a part of a step on; none where a contact there is too wide.
  std::optional<SupportBalance::Place> SupportBalance::after(const Place &from, const Eigen::VectorXd &step,
                                                             const Contacts &contacts, const double torque,
                                                             const double radius) const
  try
    {
      Place next{ moved(from.state, step, radius), {}, {} };
      next.pressed = contacts(next.state.psi, shift(next.state));
      next.left = residual(next.state, next.pressed, torque, radius);
      return next;
    }
  catch (const ComputationError &)
    {
      return {};
    }

  /// Along a step on which the energy falls at first, to where it falls ever less or rises no more than a
  /// tenth as steeply; as far as the whole step.
  std::optional<SupportBalance::Place> SupportBalance::along(const Place &from, const Eigen::VectorXd &step,
                                                             const Contacts &contacts, const double torque,
                                                             const double radius) const
  {
    constexpr int most_trials = 40;
    const double first = from.left.dot(step);
    double low = 0, high = 1, part = 1;
    for (int i = 0; i < most_trials; ++i)
      {
        std::optional<Place> next = after(from, part * step, contacts, torque, radius);
        const double slope = next ? next->left.dot(step) : 1;
        if (next && (std::abs(slope) <= 0.1 * std::abs(first) || (part == 1 && slope < 0)))
          return next;
        (slope > 0 ? high : low) = part;
        part = 0.5 * (low + high);
      }
    return {};
  }

  SupportState SupportBalance::find(const Contacts &contacts, const double torque, const double rigid_psi,
                                    const double radius) const
  {
    Place here;
    here.state.psi = rigid_psi;
    here.state.place.setZero(size_);
    here.pressed = contacts(rigid_psi, shift(here.state));
    here.left = residual(here.state, here.pressed, torque, radius);
    double usual_stiffness = 0;
    for (const SupportedContact &c : here.pressed)
      usual_stiffness = std::max(usual_stiffness, c.stiffness);
    // Against what presses at last, or a hair of what presses at first: supports may part all contacts.
    const double hair = 1e-3 * greatest_force(here.pressed);
    const auto residual_of = [&](const Place &place) {
      const double scale = std::max({ std::abs(torque) / radius, greatest_force(place.pressed), hair });
      return scale > 0 ? place.left.cwiseAbs().maxCoeff() / scale : 0;
    };
    Place best = here;
    // Newton's steps to the least energy. A bearing that nothing presses yet, or within its clearance, holds
    // nothing: then they are damped.
    constexpr int most_steps = 200, most_without_gain = 2;
    constexpr double least_damping = 1e-13, most_damping = 1e9, settled = 1e-13;
    double damping = least_damping;
    for (int i = 0, without_gain = 0; i < most_steps && without_gain < most_without_gain;)
      {
        const Eigen::VectorXd whole =
            step(here.state, here.pressed, here.left, radius, damping, usual_stiffness);
        std::optional<Place> next;
        if (here.left.dot(whole) < 0)
          next = along(here, whole, contacts, torque, radius);
        if (!next)
          {
            damping *= 100;
            if (damping > most_damping)
              break;
            continue;
          }
        ++i;
        damping = std::max(least_damping, damping / 100);
        here = std::move(*next);
        const bool gains = here.left.norm() < 0.5 * best.left.norm();
        without_gain = gains || residual_of(here) > 1e-8 ? 0 : without_gain + 1;
        if (here.left.norm() < best.left.norm())
          best = here;
        if (residual_of(best) < settled)
          break;
      }
    return best.state;
  }
} // namespace flank
