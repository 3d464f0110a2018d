// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/rollers/support_balance.hpp"

#include "mesh/base/errors.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  std::vector<Eigen::Vector2d> SupportState::of_sleeves() const
  {
    std::vector<Eigen::Vector2d> shift = pins;
    for (Eigen::Vector2d &of_sleeve : shift)
      of_sleeve += crank + carrier;
    return shift;
  }

  SupportBalance::SupportBalance(const DriveSupports &supports, const int sleeves)
      : supports_(supports)
      , sleeves_(sleeves)
  {
    const auto next = [this](const int count) {
      const int first = size_;
      size_ += count;
      return first;
    };
    if (supports.crank)
      crank_ = next(2);
    if (supports.carrier)
      carrier_ = next(2);
    if (supports.pins)
      {
        pins_ = next(2 * sleeves);
        pin_compliance_ = supports.pins->compliance();
      }
  }

  /// Calls use(number) for the first number of each support that carries a sleeve.
  template <class Use>
  void SupportBalance::each_place(const int sleeve, const Use &use) const
  {
    for (const int first : { crank_, carrier_, pins_ < 0 ? -1 : pins_ + 2 * (sleeve - 1) })
      if (first >= 0)
        use(first);
  }

  void SupportBalance::add(const int sleeve, const Eigen::Vector2d &force, Eigen::VectorXd &on_supports) const
  {
    each_place(sleeve, [&](const int first) { on_supports.segment<2>(first) += force; });
  }

  Eigen::MatrixXd SupportBalance::stiffness(const SupportState &state,
                                            const std::vector<SupportedContact> &contacts) const
  {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size_, size_);
    if (crank_ >= 0)
      sum.block<2, 2>(crank_, crank_) += supports_.crank->tangent(state.crank);
    if (carrier_ >= 0)
      sum.block<2, 2>(carrier_, carrier_) += supports_.carrier->tangent(state.carrier);
    if (pins_ >= 0)
      sum.diagonal().tail(2 * sleeves_).array() += 1 / pin_compliance_;
    for (const SupportedContact &c : contacts)
      {
        const Eigen::Matrix2d along = c.normal * c.normal.transpose(),
                              of_contact = c.stiffness * along -
                                           c.force / c.distance * (Eigen::Matrix2d::Identity() - along);
        each_place(c.sleeve, [&](const int row) {
          each_place(c.sleeve, [&](const int column) { sum.block<2, 2>(row, column) += of_contact; });
        });
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
    if (crank_ >= 0)
      result.segment<2>(1 + crank_) += supports_.crank->force(state.crank);
    if (carrier_ >= 0)
      result.segment<2>(1 + carrier_) += supports_.carrier->force(state.carrier);
    for (int n = 0; pins_ >= 0 && n < sleeves_; ++n)
      result.segment<2>(1 + pins_ + 2 * n) += state.pins[static_cast<std::size_t>(n)] / pin_compliance_;
    return result;
  }

  Eigen::VectorXd SupportBalance::step(const SupportState &state,
                                       const std::vector<SupportedContact> &contacts,
                                       const Eigen::VectorXd &residual, const double radius,
                                       const double damping) const
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
    system.diagonal().array() += damping * system.diagonal().array().abs().max(system(0, 0));
    return -Eigen::PartialPivLU<Eigen::MatrixXd>(system).solve(residual);
  }

  SupportState SupportBalance::moved(const SupportState &state, const Eigen::VectorXd &step,
                                     const double radius) const
  {
    SupportState result = state;
    result.psi += step[0] / radius;
    if (crank_ >= 0)
      result.crank += step.segment<2>(1 + crank_);
    if (carrier_ >= 0)
      result.carrier += step.segment<2>(1 + carrier_);
    for (int n = 0; pins_ >= 0 && n < sleeves_; ++n)
      result.pins[static_cast<std::size_t>(n)] += step.segment<2>(1 + pins_ + 2 * n);
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
      next.pressed = contacts(next.state.psi, next.state.of_sleeves());
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
    here.state.pins.assign(static_cast<std::size_t>(sleeves_), Eigen::Vector2d::Zero());
    here.pressed = contacts(rigid_psi, here.state.of_sleeves());
    here.left = residual(here.state, here.pressed, torque, radius);
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
        const Eigen::VectorXd whole = step(here.state, here.pressed, here.left, radius, damping);
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
    best.state.residual = residual_of(best);
    return best.state;
  }
} // namespace flank
