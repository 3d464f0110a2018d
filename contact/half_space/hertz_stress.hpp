// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/half_space/hertz.hpp"
#include "contact/half_space/subsurface.hpp"

namespace flank::half_space
{
  /// Stresses on the axis below the middle of Hertz's contact, principal there. [MPa]
  struct AxisStress
  {
    double along, across, normal; ///< to the long half-axis or the line, across it, to the surface

    double shear() const; ///< half the difference of the outer ones
    double von_mises() const;
  };

  /// Under an ellipse, at a depth >= 0 [mm]. Source: Thomas and Hoersch (1930), as Johnson (1985) has it for
  /// the elliptical pressure, in Carlson's integrals, which lose digits neither on circles nor on lines.
  AxisStress below(const HertzEllipse &contact, double depth, double poissons_ratio);

  /// Under a line, in plane strain. Source: Johnson (1985), section 4.2 (c), equations 4.46.
  AxisStress below(const HertzLine &contact, double depth, double poissons_ratio);

  /// The greatest on that axis, of two bodies pressed together: the greater of each stress. Brent's method;
  /// depths to 1e-7 of the contact's short half-axis.
  template <class Contact>
  SubsurfaceStress greatest_below(const Contact &contact, double first_poissons_ratio,
                                  double second_poissons_ratio);
} // namespace flank::half_space
