// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Dense>

#include <optional>
#include <string>
#include <vector>

namespace flank
{
  /// A double-roller drive: N_r rollers on a fixed circle, N_s = N_r - 1 sleeves on a carrier whose axis
  /// circles the fixed one with the eccentricity. [mm]
  struct DoubleRollerData
  {
    int rollers = 0;
    double roller_circle_radius = 0; ///< R
    double roller_radius = 0;        ///< R_r
    double sleeve_circle_radius = 0; ///< R1
    double sleeve_radius = 0;        ///< R_s
    double eccentricity = 0;         ///< E
    double clearance = 0;            ///< taken off every sleeve's surface, along the common normal
    std::vector<double> roller_radius_error, sleeve_radius_error; ///< added to the radii; empty: none
    std::vector<Eigen::Vector2d> roller_position_error,
        sleeve_position_error; ///< sleeves': in the carrier's frame
  };

  /// After how many pitches of the rollers (360 deg / N_r of the crank) the drive repeats. Each pitch every
  /// roller and sleeve stands where its neighbour stood: 1 where all are alike, else as many pitches as it
  /// takes until the errors of single rollers and those of single sleeves both come round.
  int pitches_in_period(const DoubleRollerData &data);

  /// The same as an angle of the crank. [rad]
  double period_of_crank(const DoubleRollerData &data);

  enum class DriveFlank
  {
    drive, ///< lever > 0
    coast
  };

  /// One pair of roller and sleeve at one position of crank and carrier.
  struct RollerPair
  {
    int roller, sleeve; ///< counted from 1
    double gap;         ///< [mm], negative: overlap
    double lever;       ///< d gap / d psi [mm/rad]
    double crank_lever; ///< -d gap / d phi at constant psi [mm/rad]
  };

  /// One roller on the exactly conjugate profile at the nominal rotation: always touching.
  struct ConjugateContact
  {
    int sleeve;             ///< lobe it touches, counted from 1
    double lever;           ///< d gap / d psi [mm/rad]
    double radius;          ///< of curvature of the profile there, negative: hollow [mm]
    Eigen::Vector2d normal; ///< of the profile there, outward, in the carrier's frame
  };

  /// Kinematics with circular sleeves. Crank angle phi counter-clockwise, the carrier turns clockwise by psi.
  /// [rad]
  class DoubleRollerDrive
  {
  public:
    /// Throws InputError (with the quantity) where the drive cannot be assembled.
    explicit DoubleRollerDrive(const DoubleRollerData &data);

    const DoubleRollerData &data() const { return data_; }
    int sleeves() const { return data_.rollers - 1; }
    double roller_pitch() const; ///< 360 deg / N_r [rad]
    double period() const;       ///< of the crank angle: whole pitches of the rollers [rad]
    double sleeve_pitch() const; ///< 360 deg / N_s [rad]
    double nominal_psi(const double phi) const { return phi / sleeves(); }

    /// Gaps and transmission errors are differences of lengths and angles a million times as great: where
    /// they are formed, numbers have three digits more.
    using Long = long double;
    using LongVector = Eigen::Matrix<Long, 2, 1>;

    /// How crank and carrier stand.
    struct Pose
    {
      double phi, psi;
      LongVector carrier_axis;
      Eigen::Matrix<Long, 2, 2> carrier;  ///< from its own frame into the fixed one
      std::vector<Eigen::Vector2d> shift; ///< of each sleeve, as what carries it gives way, in the fixed
                                          ///< frame [mm]; empty: rigid
    };
    Pose pose(double phi, double psi, std::vector<Eigen::Vector2d> shift = {}) const;

    RollerPair pair(int roller, int sleeve, const Pose &pose) const;
    RollerPair pair(const int roller, const int sleeve, const double phi, const double psi) const
    {
      return pair(roller, sleeve, pose(phi, psi));
    }

    /// Axes [mm] and radii, errors included, in the fixed frame.
    Eigen::Vector2d roller_centre(int roller) const;
    Eigen::Vector2d sleeve_centre_at(int sleeve, const Pose &pose) const;
    double roller_radius(int roller) const;
    double sleeve_radius(int sleeve) const; ///< less the clearance

    /// Rollers that a sleeve can be near to, in ascending order: the four around it; rollers do not overlap,
    /// so others are a roller away.
    std::vector<int> rollers_around(int sleeve, const Pose &pose) const;

    /// Every pair closer than `reach` [mm], up to a roller's radius.
    std::vector<RollerPair> pairs(double phi, double psi, double reach) const;

    /// Carrier rotation at which a pair touches on one flank, near the nominal one, in closed form; nan where
    /// it cannot. [rad]
    double contact_rotation(int roller, int sleeve, double phi, DriveFlank flank) const;

    /// Least gap over the period of the crank at the nominal rotation, drive and coast flank, and the least
    /// uniform clearance with which no pair overlaps, the carrier turned as suits it at each angle (0: none
    /// does). [mm]
    struct LeastGap
    {
      double drive, coast, interference = 0;
    };
    LeastGap least_gap() const { return least_gap_; }

    /// Signed radius of curvature at parameter t of the exactly conjugate sleeve profile, negative where that
    /// is hollow. [mm] The profile is the inner parallel of the roller centres' trochoid in the carrier's
    /// frame: the double-roller actuator article (bibliography in contact/bibliography.md), eqs. 3, 4.
    double conjugate_radius(double t) const;

    /// The least radii of curvature of the exactly conjugate profile over one lobe and its range of distances
    /// from the circular sleeve, at sampled points.
    struct ConjugateExtremes
    {
      double least_convex;                    ///< radius of curvature [mm]
      std::optional<double> least_hollow;     ///< radius of curvature, where the profile is hollow [mm]
      double least_departure, most_departure; ///< from the circular sleeve [mm]
    };
    ConjugateExtremes conjugate_extremes() const;

    ConjugateContact conjugate_contact(int roller, double phi) const;

    /// Distance of the conjugate profile from the circular sleeve along its normal at parameter t. [mm]
    double conjugate_departure(double t) const;

  private:
    Long contact_distance(int roller, int sleeve) const;
    static LongVector shift_of(int sleeve, const Pose &pose);
    LongVector carrier_axis(double phi) const;
    static std::vector<LongVector> centres(double radius, int count, Long first,
                                           const std::vector<Eigen::Vector2d> &errors);
    std::vector<int> rollers_around(const Eigen::Vector2d &centre) const;
    Eigen::Vector2d conjugate_point(double t) const;
    Eigen::Vector2d conjugate_tangent(double t) const; ///< d point / d t

    LeastGap find_least_gap() const;

    DoubleRollerData data_;
    std::vector<LongVector> roller_centres_, sleeve_centres_; ///< the latter in the carrier's frame
    LeastGap least_gap_;
  };
} // namespace flank
