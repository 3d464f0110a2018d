// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/double_roller/supports.hpp"

#include "mesh/base/counted.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>

namespace flank
{
  using namespace keys;

  namespace
  {
    /// Bearings among the supports: their table of keys, and what stands in messages and the keys' meanings.
    struct BearingKeys
    {
      SupportPart part;
      const char *table, *place;
    };
    constexpr std::array bearings = {
      BearingKeys{ SupportPart::needles, "needles",
                   "needles or another bearing between each sleeve and its pin" },
      BearingKeys{ SupportPart::carrier, "carrier_bearing",
                   "bearing of the carrier on the crank's eccentric" },
      BearingKeys{ SupportPart::crank, "crank_bearing", "bearing of the crank in the housing" }
    };

    std::vector<Key> bearing_keys(const std::string &bearing, const std::string &place)
    {
      const std::string of = "drive." + bearing + ".";
      return {
        text(of + "type", "rigid",
             place + ": rigid, a spring, or rolling elements that stand evenly about it, the first along +x "
                     "(ISO/TS 16281)",
             { "rigid", "spring", "balls", "rollers" }),
        numbers(of + "stiffness_N_per_um", -1e9, 1e9, "required with spring",
                "radial stiffness: one number, or k_xx, k_xy, k_yy in the fixed frame [N/um]"),
        integer(of + "elements", 3, 1000, "required with balls and rollers", "number of rolling elements"),
        number(of + "element_length_mm", 1e-3, 1e4, "required with rollers",
               "effective length of a roller of steel, whose spring constant is 35948 l^(8/9) [mm]"),
        number(of + "ball_constant_N_per_mm_1_5", 1e-3, 1e12, "required with balls",
               "load of a ball over its compression to the power 3/2 [N/mm^1.5]"),
        number(of + "radial_clearance_um", 0, 1e3, "0", "radial internal clearance, from side to side [um]"),
      };
    }
  } // namespace

  std::vector<Key> support_keys()
  {
    std::vector<Key> all = {
      text(
          "drive.pins.type", "rigid",
          "pins of the carrier in the sleeves: rigid, or beams with shear, clamped at one end or both, under "
          "a force spread evenly over the free length",
          { "rigid", "cantilever", "both_ends" }),
      number("drive.pins.diameter_mm", 1e-3, 1e4, "required with elastic pins", "diameter of a pin [mm]"),
      number("drive.pins.free_length_mm", 1e-3, 1e4, "drive.width_mm", "free length of a pin [mm]"),
      number("drive.pins.youngs_modulus_GPa", 1e-6, 1e12, "as the rollers", "of the pins [GPa]"),
      number("drive.pins.poissons_ratio", 0, 0.4999, "as the rollers", "of the pins [-]"),
    };
    for (const BearingKeys &bearing : bearings)
      for (Key &key : bearing_keys(bearing.table, bearing.place))
        all.push_back(std::move(key));
    return all;
  }

  namespace
  {
    void refuse_without(const CaseFile &file, const std::string &type, const std::string &of,
                        const std::initializer_list<const char *> keys)
    {
      for (const char *key : keys)
        if (file.has(of + key))
          throw InputError(
              file.place(of + key) +
              fmt::format("has no effect with {}type = \"{}\"; remove it, or give another type", of, type));
    }

    double required(const CaseFile &file, const std::string &of, const char *key)
    {
      if (!file.has(of + key))
        throw InputError(file.place(of + "type") + "needs " + of + key);
      return file.number(of + key);
    }

    std::optional<PinData> read_pins(const CaseFile &file, const DriveDefinition &drive)
    {
      const std::string of = "drive.pins.", type = file.text(of + "type");
      if (type == "rigid")
        {
          refuse_without(file, type, of,
                         { "diameter_mm", "free_length_mm", "youngs_modulus_GPa", "poissons_ratio" });
          return {};
        }
      PinData pins;
      pins.held = type == "cantilever" ? PinData::Held::one_end : PinData::Held::both_ends;
      pins.diameter = required(file, of, "diameter_mm");
      if (pins.diameter >= 2 * drive.drive.sleeve_radius)
        throw InputError(
            file.place(of + "diameter_mm") +
            fmt::format("must be less than the sleeves' ({:.6g} mm)", 2 * drive.drive.sleeve_radius));
      pins.free_length = file.optional_number(of + "free_length_mm").value_or(drive.contact.width);
      pins.youngs_modulus = file.has(of + "youngs_modulus_GPa")
                                ? file.number(of + "youngs_modulus_GPa") * units::gigapascal
                                : drive.contact.roller_modulus;
      pins.poissons_ratio =
          file.optional_number(of + "poissons_ratio").value_or(drive.contact.roller_poisson);
      return pins;
    }

    Eigen::Matrix2d read_stiffness(const CaseFile &file, const std::string &key)
    {
      if (!file.has(key))
        throw InputError(file.place(key.substr(0, key.rfind('.')) + ".type") + "needs " + key);
      const std::vector<double> k = file.numbers(key);
      if (k.size() != 1 && k.size() != 3)
        throw InputError(file.place(key) + fmt::format("{}, needed are 1, or 3: k_xx, k_xy, k_yy",
                                                       counted(k.size(), "number")));
      Eigen::Matrix2d stiffness = k[0] * Eigen::Matrix2d::Identity();
      if (k.size() == 3)
        stiffness << k[0], k[1], k[1], k[2];
      if (!(stiffness(0, 0) > 0) || !(stiffness.determinant() > 1e-12 * stiffness.squaredNorm()))
        throw InputError(file.place(key) + "must hold every way: k_xx > 0 and k_xx k_yy > k_xy^2");
      return stiffness * units::newton_per_micrometre;
    }

    std::optional<Bearing> read_bearing(const CaseFile &file, const std::string &name)
    {
      const std::string of = "drive." + name + ".", type = file.text(of + "type");
      if (type != "spring")
        refuse_without(file, type, of, { "stiffness_N_per_um" });
      if (type != "balls")
        refuse_without(file, type, of, { "ball_constant_N_per_mm_1_5" });
      if (type != "rollers")
        refuse_without(file, type, of, { "element_length_mm" });
      if (type == "rigid" || type == "spring")
        refuse_without(file, type, of, { "elements", "radial_clearance_um" });
      if (type == "rigid")
        return {};
      Bearing bearing;
      if (type == "spring")
        {
          bearing.stiffness = read_stiffness(file, of + "stiffness_N_per_um");
          return bearing;
        }
      if (!file.has(of + "elements"))
        throw InputError(file.place(of + "type") + "needs " + of + "elements");
      bearing.elements = file.integer(of + "elements");
      bearing.clearance = file.number(of + "radial_clearance_um") * units::micrometre;
      bearing.exponent = type == "balls" ? 1.5 : 10.0 / 9;
      bearing.constant = type == "balls" ? required(file, of, "ball_constant_N_per_mm_1_5")
                                         : roller_constant(required(file, of, "element_length_mm"));
      return bearing;
    }

    /// Models whose pairs do not tell where their sleeve stands.
    void require_places(const CaseFile &file, const DoubleRollerModel &model)
    {
      const std::string needs = "elastic pins and bearings move the sleeves: ";
      if (model.conjugate)
        throw InputError(file.place("drive.profile") + needs + "give circular sleeves");
      if (model.linear || model.window || model.drop_interfering || model.backlash == Backlash::zero)
        throw InputError(file.place("model.preset") + needs +
                         "give the exact geometry (model.geometry = iterate, candidates = all, "
                         "drop_interfering = no, backlash = exact or drive_only)");
      if (model.input_torque)
        throw InputError(file.place("model.torque_on") + needs + "give the torque on the output");
    }
  } // namespace

  DriveSupports read_supports(const CaseFile &file, const DriveDefinition &drive)
  {
    DriveSupports supports;
    if (const std::optional<PinData> pins = read_pins(file, drive))
      supports.elastic[SupportPart::pin] = pins->spring();
    for (const BearingKeys &bearing : bearings)
      if (const std::optional<Bearing> law = read_bearing(file, bearing.table))
        supports.elastic[bearing.part] = *law;
    if (supports.any())
      require_places(file, drive.model);
    return supports;
  }

  std::string name_of(const SupportPart part)
  {
    switch (part)
      {
      case SupportPart::needles:
        return "needles";
      case SupportPart::pin:
        return "pins";
      case SupportPart::carrier:
        return "carrier bearing";
      default:
        return "crank bearing";
      }
  }

  std::string described(const DriveSupports &supports)
  {
    std::vector<std::string> elastic, rigid = { "rollers", "sleeves" };
    for (const SupportPart part : support_parts)
      (supports.elastic.contains(part) ? elastic : rigid).push_back(name_of(part));
    rigid.emplace_back("housing");
    return (elastic.empty() ? "" : fmt::format("elastic: {}; ", fmt::join(elastic, ", "))) +
           fmt::format("rigid but for their contacts: {}", fmt::join(rigid, ", "));
  }
} // namespace flank
