// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/rollers/drive_definition.hpp"
#include "contact/rollers/pair_laws.hpp"
#include "contact/rollers/support_balance.hpp"

namespace flank
{
  struct RollerPairLoad
  {
    int roller, sleeve;
    double force, approach;                           ///< [N], [mm]
    double max_pressure, mid_pressure, edge_pressure; ///< [MPa]
    double lever;                                     ///< [mm], > 0: drive flank
    double sleeve_radius;                             ///< of curvature at the contact [mm]
  };

  /// A support: the force of the pairs that it carries, from rollers towards sleeves, and how far it has
  /// given way by it, against what lies about it; in the fixed frame.
  struct SupportLoad
  {
    SupportPart part;
    int sleeve;                            ///< of needles or a pin, counted from 1; else 0
    double force_x, force_y;               ///< [N]
    double displacement_x, displacement_y; ///< [mm]
  };

  /// The parts of the transmission error, which add up to it: by the work of the pairs' forces at the torque.
  /// No numbers where pairs of the coast flank carry too. [rad]
  struct LagShares
  {
    double contact = 0;                 ///< what contacts give way
    std::array<double, 4> support = {}; ///< what supports do, in the order of support_parts
    double gaps = 0;                    ///< what is open unloaded, levers that change included
  };

  /// One crank angle at one torque.
  struct DrivePosition
  {
    double crank_angle = 0, torque = 0; ///< [rad], [N mm] as the case gives it
    double psi = 0;                     ///< carrier rotation, clockwise [rad]
    double lag = 0;           ///< transmission error: how far the carrier stays behind phi/N_s [rad]
    double gear_ratio = 0;    ///< instantaneous: d phi / d psi at constant torque
    double stiffness = 0;     ///< tangent, of the carrier's torque [N mm/rad]
    double torque_by_lag = 0; ///< rate of the torque as the case gives it: the stiffness, or where it acts on
                              ///< the crank, that of the crank's torque [N mm/rad]
    double balance = 0; ///< |sum l F - T| over |T| (or the greatest l F): the certificate of the position
    double balance_over_allowed = 0;   ///< allowed: 1e-10, or what the rounding of the gaps lets the forces
                                       ///< vary by
    double certificate = 0;            ///< worst of the contact solutions under its pairs, relative
    std::vector<RollerPairLoad> pairs; ///< loaded ones
    std::vector<SupportLoad> supports; ///< elastic ones that carry, or float within a clearance
    LagShares shares;                  ///< zeros without a torque
  };

  /// A pair as it stands in the load balance.
  struct PairPlace
  {
    int roller, sleeve;
    double gap; ///< as the model has it: exact, or linear in psi about the nominal rotation [mm]
    double lever, crank_lever; ///< torque that a unit force on the pair puts on the carrier, and on the crank
                               ///< [mm/rad]
    double sleeve_radius;      ///< of curvature at the contact [mm]
  };

  /// The load balance of the drive: pairs couple through the carrier's rotation alone.
  class LoadedDrive
  {
  public:
    explicit LoadedDrive(const DriveDefinition &input); ///< kept by reference
    explicit LoadedDrive(DriveDefinition &&) = delete;

    /// Throws ComputationError where no rotation near the nominal one carries the torque.
    DrivePosition solve(double crank_angle, double torque) const;

    /// Gear ratio over the next degree of the crank at the same torque.
    double secant_gear_ratio(const DrivePosition &position) const;

    /// Carrier rotation of the unloaded drive: where the drive flank first touches, or, of a drive that
    /// overlaps, where its forces balance. [rad]
    double unloaded_psi(double crank_angle) const;

    /// Greatest pair force of the unloaded drive at a crank angle, from interference. [N]
    double preload(double crank_angle) const;

    /// Unit vector from a roller's axis to where its sleeve presses on it, in the fixed frame.
    Eigen::Vector2d towards_sleeve(int roller, int sleeve, double crank_angle, double psi) const;

    const DoubleRollerDrive &drive() const { return drive_; }
    const PairLaws &laws() const { return laws_; }

    /// The pairs that take part at a crank angle and a carrier rotation [rad], the sleeves shifted as what
    /// carries them gives way (empty: rigid).
    std::vector<PairPlace> pairs(double crank_angle, double psi,
                                 const std::vector<Eigen::Vector2d> &shift = {}) const;

  private:
    using Shift = std::vector<Eigen::Vector2d>;

    bool is_linearised() const; ///< whether pairs are chosen at the nominal rotation
    std::vector<PairPlace> near_pairs(double crank_angle, double psi, const Shift &shift) const;

    /// Where the carrier and its supports stand under a torque; the rotation alone where all are rigid.
    SupportState balance(double crank_angle, double torque) const;

    /// The certificate of supports: their forces by their own displacements against those of the pairs that
    /// they carry, summed anew. Throws ComputationError where they differ by more than 1e-10 of the greatest,
    /// or than the rounding of the gaps.
    void certify(double crank_angle, double torque, SupportState &state) const;

    /// The loaded pairs as the supports see them.
    std::vector<SupportedContact> supported(double crank_angle, double psi, const Shift &shift) const;

    /// Looks for overlaps among all rollers and sleeves at a solution, by their distances alone. Throws
    /// ComputationError if a pair overlaps that carries nothing.
    void require_all_pairs(const DrivePosition &position, const Shift &shift) const;

    struct Sum
    {
      double torque, slope; ///< torque of the balance [N mm], and its derivative by the lag [N mm/rad]
      double greatest;      ///< |l F| of the most loaded pair: scale of the balance
    };
    Sum sum(double crank_angle, double psi) const;

    /// What one loaded pair adds to the rates of the balance while crank and carrier turn: sum l F stays, l
    /// its lever in the balance, so that sum l (K d(-gap) + dF/dradius dradius) + F dl = 0.
    struct Rates
    {
      double stiffness;      ///< of the carrier's torque by its rotation [N mm/rad]
      double by_psi, by_phi; ///< of the balance, falling with psi, growing with phi [N mm/rad]
    };
    Rates rates(const PairPlace &pair, const PairState &state, double crank_angle, double psi,
                const Shift &shift) const;

    /// Fills in the supports and the parts of the transmission error.
    void tell_supports(DrivePosition &position, const SupportState &state) const;

    /// Sums over the loaded pairs of a position, l their lever in the balance.
    struct Balance
    {
      double by_psi = 0, by_phi = 0; ///< of the balance, by the rotations (as Rates) [N mm/rad]
      double moment = 0;             ///< sum l F [N mm]
      double greatest = 0;           ///< |l F| of the most loaded pair [N mm]
      double sensitivity = 0;        ///< sum |l| dF/dapproach: moment by an error of the gaps [N mm/mm]
    };

    /// Takes from a position's stiffness and from the rates what its supports give way as it turns.
    void condense(DrivePosition &position, const SupportState &state, Balance &sum) const;

    /// Fills in the loaded pairs and the stiffness of a position whose rotations and torque are known.
    Balance load_pairs(DrivePosition &position, const Shift &shift) const;

    /// Fills in the balance of a position. Throws ComputationError where it is worse than rounding allows, or
    /// where a torque closes no pair.
    void require_balance(DrivePosition &position, const Balance &sum) const;

    Sum sum_or_beyond(double crank_angle, double psi) const; ///< infinite where a contact is too wide

    /// Carrier rotation at which the drive flank first touches; -infinity: it does not. [rad]
    double drive_touch(double crank_angle) const;

    /// How crank and carrier stand at a rotation of the carrier, and how at its nominal rotation.
    struct Poses
    {
      DoubleRollerDrive::Pose here, nominal;
    };
    Poses poses(double crank_angle, double psi, const Shift &shift = {}) const;

    /// One pair as the model has it, whether it takes part or not. Of a conjugate profile the roller tells
    /// the sleeve.
    PairPlace place(int roller, int sleeve, const Poses &at) const;

    /// The lever that counts in the load balance: the carrier's or the crank's, whichever the torque acts on.
    double lever(const PairPlace &pair) const;

    /// A quarter of the sleeves' pitch: how far from the nominal rotation, or from first touch, a balance is
    /// sought. [rad]
    double farthest_lag() const;

    double find_psi(double crank_angle, double torque) const; ///< on rigid supports
    SupportState unloaded(double crank_angle) const;          ///< as unloaded_psi()
    double first_touch(double crank_angle) const;             ///< -1e300: no pair touches

    const DriveDefinition &input_;
    DoubleRollerDrive drive_;
    PairLaws laws_;
    SupportBalance support_balance_;
  };
} // namespace flank
