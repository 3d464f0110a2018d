// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/rollers/unloaded_contacts.hpp"

#include "mesh/base/units.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    std::vector<UnloadedContact> conjugate_contacts(const LoadedDrive &drive, const double phi)
    {
      const double nominal = drive.drive().nominal_psi(phi);
      std::vector<UnloadedContact> contacts;
      for (const PairPlace &p : drive.pairs(phi, nominal))
        contacts.push_back({ .roller = p.roller,
                             .sleeve = p.sleeve,
                             .flank = p.lever > 0 ? DriveFlank::drive : DriveFlank::coast,
                             .rotation = nominal,
                             .backlash = 0,
                             .gap = p.gap,
                             .lever = p.lever,
                             .first = nominal });
      return contacts;
    }
  } // namespace

  std::vector<UnloadedContact> unloaded_contacts(const LoadedDrive &drive, const bool conjugate,
                                                 const double phi)
  {
    if (conjugate)
      return conjugate_contacts(drive, phi);
    const DoubleRollerDrive &kinematics = drive.drive();
    const double near = units::pi / 2 / kinematics.sleeves(), nominal = kinematics.nominal_psi(phi);
    // Levers reach E N_s. One that is nothing beside that is a pair at its reversal, on neither flank.
    const double no_lever = 1e-9 * kinematics.data().eccentricity * kinematics.sleeves();
    const DoubleRollerDrive::Pose pose = kinematics.pose(phi, nominal);
    double phi_d = -1e300, phi_c = 1e300; // first of the drive flank, first of the coast flank
    std::vector<UnloadedContact> contacts;
    for (int n = 1; n <= kinematics.sleeves(); ++n)
      for (const int k : kinematics.rollers_around(n, pose))
        for (const DriveFlank flank : { DriveFlank::drive, DriveFlank::coast })
          {
            const double rotation = kinematics.contact_rotation(k, n, phi, flank);
            const RollerPair here = kinematics.pair(k, n, pose);
            if (std::isnan(rotation) || std::abs(rotation - nominal) > near ||
                std::abs(here.lever) < no_lever || (here.lever > 0) != (flank == DriveFlank::drive))
              continue; // each pair can touch on the flank it is on
            if (flank == DriveFlank::drive)
              phi_d = std::max(phi_d, rotation);
            else
              phi_c = std::min(phi_c, rotation);
            contacts.push_back({ .roller = k,
                                 .sleeve = n,
                                 .flank = flank,
                                 .rotation = rotation,
                                 .backlash = 0,
                                 .gap = here.gap,
                                 .lever = kinematics.pair(k, n, phi, rotation).lever,
                                 .first = 0 });
          }
    for (UnloadedContact &contact : contacts)
      {
        const double rotation = contact.rotation;
        contact.first = contact.flank == DriveFlank::drive ? phi_d : phi_c;
        contact.backlash = contact.flank == DriveFlank::drive ? phi_d - rotation : rotation - phi_c;
      }
    return contacts;
  }
} // namespace flank
