// SPDX-License-Identifier: GPL-2.0-or-later
// A drive whose pins and bearings give way.
#include "contact/rollers/drive_position.hpp"

#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace flank
{
  std::vector<SupportedContact> LoadedDrive::supported(const double phi, const double psi,
                                                       const Shift &shift) const
  {
    const DoubleRollerDrive::Pose pose = drive_.pose(phi, psi, shift);
    std::vector<SupportedContact> contacts;
    for (const PairPlace &p : pairs(phi, psi, shift))
      if (p.gap < 0)
        {
          const PairState state = laws_.load_at(p.sleeve_radius, -p.gap);
          const Eigen::Vector2d apart =
              drive_.sleeve_centre_at(p.sleeve, pose) - drive_.roller_centre(p.roller);
          contacts.push_back({ .roller = p.roller,
                               .sleeve = p.sleeve,
                               .lever = p.lever,
                               .normal = apart.normalized(),
                               .distance = apart.norm(),
                               .force = state.force,
                               .stiffness = state.stiffness });
        }
    return contacts;
  }

  SupportState LoadedDrive::balance(const double phi, const double torque) const
  {
    const double rigid = find_psi(phi, torque);
    if (!input_.supports.any())
      return { .psi = rigid };
    SupportState state = support_balance_.find(
        [&](const double psi, const Shift &shift) { return supported(phi, psi, shift); }, torque, rigid,
        input_.drive.sleeve_circle_radius);
    certify(phi, torque, state);
    return state;
  }

  void LoadedDrive::certify(const double phi, const double torque, SupportState &state) const
  {
    Shift on_sleeves(static_cast<std::size_t>(drive_.sleeves()), Eigen::Vector2d::Zero());
    Eigen::Vector2d on_carrier = Eigen::Vector2d::Zero();
    double greatest = std::abs(torque) / input_.drive.sleeve_circle_radius, sensitivity = 0;
    for (const SupportedContact &c : supported(phi, state.psi, support_balance_.shift(state)))
      {
        on_sleeves[static_cast<std::size_t>(c.sleeve - 1)] += c.force * c.normal;
        on_carrier += c.force * c.normal;
        greatest = std::max(greatest, c.force);
        sensitivity += c.stiffness;
      }
    double worst = 0;
    for (const auto &[part, law] : input_.supports.elastic)
      for (int n = 1; n <= drive_.sleeves(); ++n)
        {
          const Eigen::Vector2d on =
              is_of_sleeve(part) ? on_sleeves[static_cast<std::size_t>(n - 1)] : on_carrier;
          worst = std::max(worst, (law.force(support_balance_.displacement(state, part, n)) - on).norm());
        }
    state.balance = greatest > 0 ? worst / greatest : 0;
    // As in require_balance(): what the rounding of the gaps lets the forces vary by.
    const double rounding = 10 * std::numeric_limits<double>::epsilon() * input_.drive.roller_circle_radius *
                            sensitivity,
                 allowed = std::max(1e-10, greatest > 0 ? rounding / greatest : 0);
    state.balance_over_allowed = state.balance / allowed;
    if (!(state.balance <= allowed))
      throw ComputationError(fmt::format(
          "the forces of pins and bearings do not come into balance at crank angle {:.4f} deg, torque {:.6g} "
          "N m: {:.3g} of the greatest pair's force is left, allowed is {:.3g}; where they are so soft that "
          "sleeves leave their rollers, make them stiffer or lower the torque",
          phi / units::degree, torque / units::newton_metre, state.balance, allowed));
  }

  void LoadedDrive::condense(DrivePosition &position, const SupportState &state, Balance &sum) const
  {
    if (state.place.size() == 0 || position.pairs.empty())
      return;
    constexpr double h = 1e-5; // as in rates()
    const double phi = position.crank_angle, psi = position.psi;
    const Shift shift = support_balance_.shift(state);
    const std::vector<SupportedContact> contacts = supported(phi, psi, shift);
    Eigen::VectorXd by_psi = Eigen::VectorXd::Zero(support_balance_.size()), by_phi = by_psi;
    const auto add_rate = [&](const SupportedContact &c, const DoubleRollerDrive::Pose &ahead,
                              const DoubleRollerDrive::Pose &behind, Eigen::VectorXd &rate) {
      const auto normal = [&](const DoubleRollerDrive::Pose &pose) {
        return (drive_.sleeve_centre_at(c.sleeve, pose) - drive_.roller_centre(c.roller)).normalized();
      };
      const double gap =
          drive_.pair(c.roller, c.sleeve, ahead).gap - drive_.pair(c.roller, c.sleeve, behind).gap;
      const Eigen::Vector2d force = c.force * (normal(ahead) - normal(behind)) - c.stiffness * gap * c.normal;
      support_balance_.add(c.sleeve, -force / (2 * h), rate);
    };
    for (const SupportedContact &c : contacts)
      {
        add_rate(c, drive_.pose(phi, psi + h, shift), drive_.pose(phi, psi - h, shift), by_psi);
        add_rate(c, drive_.pose(phi + h, psi, shift), drive_.pose(phi - h, psi, shift), by_phi);
      }
    Eigen::MatrixXd stiffness = support_balance_.stiffness(state, contacts);
    for (Eigen::Index k = 0; k < stiffness.rows(); ++k)
      if (stiffness(k, k) == 0) // floats within its clearance
        stiffness(k, k) = 1;
    const Eigen::VectorXd given = Eigen::PartialPivLU<Eigen::MatrixXd>(stiffness).solve(by_psi);
    position.stiffness -= given.dot(by_psi);
    sum.by_psi -= given.dot(by_psi);
    sum.by_phi += given.dot(by_phi);
  }

  void LoadedDrive::tell_supports(DrivePosition &position, const SupportState &state) const
  {
    const Shift shift = support_balance_.shift(state);
    const DoubleRollerDrive::Pose pose = drive_.pose(position.crank_angle, position.psi, shift);
    Shift on_sleeves(static_cast<std::size_t>(drive_.sleeves()), Eigen::Vector2d::Zero());
    Eigen::Vector2d on_carrier = Eigen::Vector2d::Zero();
    double carried = 0, by_contacts = 0;
    bool coasts = false;
    for (const RollerPairLoad &pair : position.pairs)
      {
        const Eigen::Vector2d force =
            pair.force *
            (drive_.sleeve_centre_at(pair.sleeve, pose) - drive_.roller_centre(pair.roller)).normalized();
        on_sleeves[static_cast<std::size_t>(pair.sleeve - 1)] += force;
        on_carrier += force;
        carried += pair.lever * pair.force;
        coasts = coasts || pair.lever < 0;
        by_contacts += pair.approach * pair.force;
      }
    std::array<double, support_parts.size()> by_support = {};
    const auto tell = [&](const std::size_t k, const int sleeve, const Eigen::Vector2d &force) {
      const Eigen::Vector2d by = support_balance_.displacement(state, support_parts[k], sleeve);
      position.supports.push_back({ support_parts[k], sleeve, force.x(), force.y(), by.x(), by.y() });
      by_support[k] += force.dot(by);
    };
    for (std::size_t k = 0; k < support_parts.size(); ++k)
      {
        if (!input_.supports.elastic.contains(support_parts[k]))
          continue;
        if (!is_of_sleeve(support_parts[k]))
          tell(k, 0, on_carrier);
        for (int n = 1; is_of_sleeve(support_parts[k]) && n <= drive_.sleeves(); ++n)
          if (const Eigen::Vector2d &force = on_sleeves[static_cast<std::size_t>(n - 1)];
              force.norm() > 0 || support_balance_.displacement(state, support_parts[k], n).norm() > 0)
            tell(k, n, force);
      }
    if (position.torque == 0 || carried == 0)
      return;
    LagShares &shares = position.shares;
    if (coasts) // then work is done against the torque too, and forces of the preload are in every part
      {
        constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
        shares.contact = shares.gaps = unknown;
        shares.support.fill(unknown);
        return;
      }
    shares.contact = by_contacts / carried;
    shares.gaps = position.lag - shares.contact;
    for (std::size_t k = 0; k < by_support.size(); ++k)
      {
        shares.support[k] = by_support[k] / carried;
        shares.gaps -= shares.support[k];
      }
  }
} // namespace flank
