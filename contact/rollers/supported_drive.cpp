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
    const SupportState state = support_balance_.find(
        [&](const double psi, const Shift &shift) { return supported(phi, psi, shift); }, torque, rigid,
        input_.drive.sleeve_circle_radius);
    constexpr double allowed = 1e-10;
    if (!(state.residual <= allowed))
      throw ComputationError(fmt::format(
          "the forces of pins and bearings do not come into balance at crank angle {:.4f} deg, torque {:.6g} "
          "N m: {:.3g} of the greatest pair's force is left, allowed is {:.3g}; where they are so soft that "
          "sleeves "
          "leave their rollers, make them stiffer or lower the torque",
          phi / units::degree, torque / units::newton_metre, state.residual, allowed));
    return state;
  }

  void LoadedDrive::condense(DrivePosition &position, const SupportState &state, Balance &sum) const
  {
    if (!input_.supports.any() || position.pairs.empty())
      return;
    constexpr double h = 1e-5; // as in rates()
    const double phi = position.crank_angle, psi = position.psi;
    const Shift shift = state.of_sleeves();
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
    const Eigen::VectorXd given =
        Eigen::PartialPivLU<Eigen::MatrixXd>(support_balance_.stiffness(state, contacts)).solve(by_psi);
    position.stiffness -= given.dot(by_psi);
    sum.by_psi -= given.dot(by_psi);
    sum.by_phi += given.dot(by_phi);
  }

  void LoadedDrive::tell_supports(DrivePosition &position, const SupportState &state) const
  {
    const Shift shift = state.of_sleeves();
    const DoubleRollerDrive::Pose pose = drive_.pose(position.crank_angle, position.psi, shift);
    Shift on_pins(static_cast<std::size_t>(drive_.sleeves()), Eigen::Vector2d::Zero());
    Eigen::Vector2d on_bearings = Eigen::Vector2d::Zero();
    double carried = 0, by_contacts = 0, by_pins = 0;
    bool coasts = false;
    for (const RollerPairLoad &pair : position.pairs)
      {
        const Eigen::Vector2d force =
            pair.force *
            (drive_.sleeve_centre_at(pair.sleeve, pose) - drive_.roller_centre(pair.roller)).normalized();
        on_pins[static_cast<std::size_t>(pair.sleeve - 1)] += force;
        on_bearings += force;
        carried += pair.lever * pair.force;
        coasts = coasts || pair.lever < 0;
        by_contacts += pair.approach * pair.force;
      }
    const auto tell = [&](const SupportPart part, const int sleeve, const Eigen::Vector2d &force,
                          const Eigen::Vector2d &displacement) {
      position.supports.push_back({ part, sleeve, force.x(), force.y(), displacement.x(), displacement.y() });
      return force.dot(displacement);
    };
    if (input_.supports.pins)
      for (int n = 1; n <= drive_.sleeves(); ++n)
        if (const Eigen::Vector2d &force = on_pins[static_cast<std::size_t>(n - 1)]; force.norm() > 0)
          by_pins += tell(SupportPart::pin, n, force, state.pins[static_cast<std::size_t>(n - 1)]);
    const double by_carrier =
                     input_.supports.carrier ? tell(SupportPart::carrier, 0, on_bearings, state.carrier) : 0,
                 by_crank = input_.supports.crank ? tell(SupportPart::crank, 0, on_bearings, state.crank) : 0;
    if (position.torque == 0 || carried == 0)
      return;
    LagShares &shares = position.shares;
    if (coasts) // then work is done against the torque too, and forces of the preload are in every part
      {
        constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
        shares = { unknown, unknown, unknown, unknown, unknown };
        return;
      }
    shares = { by_contacts / carried, by_pins / carried, by_carrier / carried, by_crank / carried };
    shares.gaps = position.lag - shares.contact - shares.pins - shares.carrier - shares.crank;
  }
} // namespace flank
