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

  SupportState SupportBalance::find(const Contacts &contacts, const double torque, const double rigid_psi,
                                    const double radius) const
  {
    SupportState state;
    state.psi = rigid_psi;
    state.pins.assign(static_cast<std::size_t>(sleeves_), Eigen::Vector2d::Zero());
    std::vector<SupportedContact> pressed = contacts(state.psi, state.of_sleeves());
    Eigen::VectorXd left = residual(state, pressed, torque, radius);
    // Levenberg and Marquardt: a bearing that nothing presses yet, or within its clearance, holds nothing.
    constexpr int most_trials = 400;
    constexpr double least_damping = 1e-13, most_damping = 1e6, settled = 1e-15;
    double damping = least_damping;
    for (int i = 0;
         i < most_trials && damping < most_damping && left.norm() > settled * std::abs(torque) / radius; ++i)
      {
        bool is_better = false;
        try
          {
            const SupportState next = moved(state, step(state, pressed, left, radius, damping), radius);
            std::vector<SupportedContact> there = contacts(next.psi, next.of_sleeves());
            Eigen::VectorXd of_next = residual(next, there, torque, radius);
            is_better = of_next.norm() < left.norm();
            if (is_better)
              state = next, pressed = std::move(there), left = std::move(of_next);
          }
        catch (const ComputationError &) // too wide a contact on the way
          {
          }
        damping = is_better ? std::max(least_damping, damping / 30) : 10 * damping;
      }
    double greatest = std::abs(torque) / radius;
    for (const SupportedContact &c : pressed)
      greatest = std::max(greatest, c.force);
    state.residual = greatest > 0 ? left.cwiseAbs().maxCoeff() / greatest : 0;
    return state;
  }
} // namespace flank
