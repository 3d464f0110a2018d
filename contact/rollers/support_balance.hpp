// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/rollers/drive_supports.hpp"

#include <functional>
#include <vector>

namespace flank
{
  /// A loaded pair of a drive as its supports see it: the sleeve is pressed off the roller along the normal.
  struct SupportedContact
  {
    int roller, sleeve;     ///< counted from 1
    double lever;           ///< of the carrier [mm]
    Eigen::Vector2d normal; ///< from the roller to the sleeve, in the fixed frame
    double distance;        ///< of both centres [mm]
    double force;           ///< [N]
    double stiffness;       ///< of the contact [N/mm]
  };

  /// How far a drive's supports have given way.
  struct SupportState
  {
    double psi = 0;        ///< rotation of the carrier [rad]
    Eigen::VectorXd place; ///< displacements of the supports, in the fixed frame: SupportBalance [mm]
    double balance = 0;    ///< greatest difference of a support's force and that of the pairs on it, over the
                           ///< greatest force: LoadedDrive::certify()
    double balance_over_allowed = 0;
  };

  /// Equilibrium of a carrier on elastic pins and bearings: the rotation at which its pairs carry the torque
  /// and at which each support's force is that of the pairs it carries.
  class SupportBalance
  {
  public:
    /// The loaded pairs at a rotation of the carrier [rad] with its sleeves displaced. May throw
    /// ComputationError where a contact is too wide.
    using Contacts =
        std::function<std::vector<SupportedContact>(double psi, const std::vector<Eigen::Vector2d> &shift)>;

    /// supports: kept by reference.
    SupportBalance(const DriveSupports &supports, int sleeves);

    /// From the rotation of the drive on rigid supports on, by Newton's method on its energy. radius: that
    /// of the sleeves' circle, a length for rotations [mm]. The nearest place found where it does not settle:
    /// whoever uses it must look.
    SupportState find(const Contacts &contacts, double torque, double rigid_psi, double radius) const;

    /// Numbers by which the supports' place is described.
    int size() const { return size_; }

    /// By how much each sleeve stands beside its place on the rigid drive; empty: nothing has given way. [mm]
    std::vector<Eigen::Vector2d> shift(const SupportState &state) const;

    /// The displacement of a support. sleeve: of needles or a pin, counted from 1. [mm]
    Eigen::Vector2d displacement(const SupportState &state, SupportPart part, int sleeve) const;

    /// Stiffness of supports and contacts at a place. [N/mm]
    Eigen::MatrixXd stiffness(const SupportState &state, const std::vector<SupportedContact> &contacts) const;

    /// Adds a force on a sleeve, in the fixed frame, to those on the supports that carry it.
    void add(int sleeve, const Eigen::Vector2d &force, Eigen::VectorXd &on_supports) const;

  private:
    /// A support's law, and the first of its numbers; of needles and pins those of the first sleeve.
    struct Support
    {
      SupportPart part;
      const Bearing *law;
      int first, count;
      int place(const int sleeve) const { return is_of_sleeve(part) ? first + 2 * (sleeve - 1) : first; }
    };
    SupportState moved(const SupportState &state, const Eigen::VectorXd &step, double radius) const;
    Eigen::VectorXd residual(const SupportState &state, const std::vector<SupportedContact> &contacts,
                             double torque, double radius) const;
    Eigen::VectorXd step(const SupportState &state, const std::vector<SupportedContact> &contacts,
                         const Eigen::VectorXd &residual, double radius, double damping,
                         double usual_stiffness) const;
    struct Place;
    std::optional<Place> after(const Place &from, const Eigen::VectorXd &step, const Contacts &contacts,
                               double torque, double radius) const;
    std::optional<Place> along(const Place &from, const Eigen::VectorXd &step, const Contacts &contacts,
                               double torque, double radius) const;

    int sleeves_, size_ = 0;
    std::vector<Support> supports_;
  };
} // namespace flank
