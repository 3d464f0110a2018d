// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/input/flank_input.hpp"

#include "cases/parallel_axis/input/topography_file.hpp"
#include "contact/flanks/mesh_position.hpp"
#include "mesh/base/counted.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/units.hpp"

#include <fmt/format.h>

namespace flank
{
  namespace
  {
    using units::micrometre, units::degree;

    /// Reads the tables of one flank.
    class FlankReader
    {
    public:
      FlankReader(const CaseFile &file, const GearPair &pair, const Gear &gear, const RollAngles &roll,
                  const Flank flank)
          : file_(file)
          , pair_(pair)
          , gear_(gear)
          , roll_(roll)
          , flank_(flank)
      {
      }

      FlankInput read()
      {
        relief("tip_relief", roll_.tip);
        relief("root_relief", roll_.start_of_active_profile);
        if (counts("profile_slope"))
          add<ProfileSlope>(by_amount("profile_slope"), amount("profile_slope"),
                            roll_.start_of_active_profile, roll_.tip);
        if (counts("profile_crown"))
          add<ProfileCrown>(by_amount("profile_crown"), amount("profile_crown"),
                            roll_.start_of_active_profile, roll_.tip);
        if (counts("lead_crown"))
          add<LeadCrown>(by_amount("lead_crown"), amount("lead_crown"), gear_.face_width);
        if (counts("helix_slope"))
          {
            const double sign = along_z("helix_slope.amount_um");
            add<HelixSlope>({ { table("helix_slope") + ".amount_um",
                                Parameter::amount,
                                { .factor = sign * micrometre } } },
                            sign * amount("helix_slope"), gear_.face_width);
          }
        end_relief();
        const std::string biases = table("bias");
        for (int i = 1, n = file_.count(biases); i <= n; ++i)
          bias(fmt::format("{}[{}].", biases, i));
        if (const std::string key = table("topography") + ".file"; file_.text(key) != "none")
          result_.deviations.modifications.push_back(
              read_topography(file_, key, pair_, gear_, roll_, along_z("topography.file") < 0));
        single_teeth();
        return result_;
      }

    private:
      /// Where a table stands: with this flank alone, or with both.
      std::string table(const std::string &name) const
      {
        const std::string own = gear_.name + "." + name_of(flank_) + "." + name;
        for (const char *end : { ".", "[" })
          if (file_.has_any(own + end))
            return own;
        return file_.has(own) ? own : gear_.name + "." + name;
      }

      double amount(const std::string &name) const
      {
        return file_.number(table(name) + ".amount_um") * micrometre;
      }

      /// -1 where the pinion's value along z is taken over: the gear is its mirror image.
      double along_z(const std::string &key) const
      {
        const auto dot = key.find('.');
        return file_.copied(table(key.substr(0, dot)) + key.substr(dot)) ? -1 : 1;
      }

      using Parameter = FlankModification::Parameter;
      struct Use
      {
        std::string key;
        Parameter by;
        ParameterScale scale;
      };

      template <class Modification, class... Arguments>
      void add(const std::vector<Use> &uses, Arguments &&...arguments)
      {
        result_.deviations.modifications.push_back(
            std::make_shared<Modification>(std::forward<Arguments>(arguments)...));
        for (const Use &use : uses)
          result_.by_key[file_.copied(use.key) ? "pinion." + use.key.substr(5) : use.key].push_back(
              { result_.deviations.modifications.back(), use.by, file_.number(use.key), use.scale });
      }

      std::vector<Use> by_amount(const std::string &name) const
      {
        return { { table(name) + ".amount_um", Parameter::amount, { .factor = micrometre } } };
      }

      /// Whether a modification counts: one that removes nothing does not, unless its derivatives are asked
      /// for.
      bool counts(const std::string &name) const
      {
        return file_.has(table(name) + ".amount_um") && matters(amount(name));
      }
      bool matters(const double amount) const
      {
        return amount != 0 || file_.text("output.derivatives") == "yes";
      }

      /// Shape and blend of a relief of an amount [mm], which grows by `gradient` of itself along the flank
      /// where it starts [1/mm].
      ReliefForm form(const std::string &prefix, const double amount, const double gradient) const
      {
        const bool linear = file_.text(prefix + "shape") == "linear";
        const std::string key = prefix + "blend_radius_mm";
        const ReliefForm result{ linear ? ReliefShape::linear : ReliefShape::quadratic,
                                 file_.has(key) ? file_.number(key) : 0 };
        if (result.blend_radius > 0 && !linear)
          throw InputError(file_.place(key) + "has no effect: a quadratic relief starts without a kink");
        if (const double half = result.half_blend(amount, gradient); half > 1)
          throw InputError(file_.place(key) +
                           fmt::format("an arc of this radius is longer than the relief; allowed is 0 to "
                                       "{:.4g} mm",
                                       result.blend_radius / half));
        return result;
      }

      /// A start as roll angle, diameter or length of roll [rad], and the key that says it.
      std::pair<double, Use> start(const std::string &prefix, const double low, const double high) const
      {
        std::string given;
        for (const char *key : { "start_roll_angle_deg", "start_diameter_mm", "start_length_of_roll_mm" })
          if (file_.has(prefix + key))
            {
              if (!given.empty())
                throw InputError(file_.place(prefix + key) + "contradicts " + given +
                                 ", which says the same; give one of the two");
              given = prefix + key;
            }
        if (given.empty())
          throw InputError(fmt::format(
              "{}: {}start_roll_angle_deg: missing; give it, start_diameter_mm or start_length_of_roll_mm",
              file_.file(), prefix));
        const double value = file_.number(given), rb = gear_.base_radius;
        const bool as_diameter = given.ends_with("_diameter_mm"), as_length = given.ends_with("_of_roll_mm");
        if (as_diameter && value / 2 < rb)
          throw InputError(file_.place(given) +
                           fmt::format("below the base circle, diameter {:.4f} mm", 2 * rb));
        using Kind = ParameterScale::Kind;
        const ParameterScale scale{ as_diameter ? Kind::diameter
                                    : as_length ? Kind::length_of_roll
                                                : Kind::multiple,
                                    degree, rb };
        const double roll = scale.own(value);
        if (roll <= low - 1e-12 || roll >= high)
          {
            const auto shown = [&](const double r) {
              return as_diameter ? 2 * radius_at_roll(r, rb) : as_length ? rb * r : r / degree;
            };
            throw InputError(
                file_.place(given) +
                fmt::format("the relief must start inside the active profile, allowed is {:.4f} to {:.4f} {}",
                            shown(low), shown(high), as_diameter || as_length ? "mm" : "deg"));
          }
        return { roll, { given, Parameter::start, scale } };
      }

      void relief(const std::string &name, const double end)
      {
        const std::string prefix = table(name) + ".";
        if (!file_.has(prefix + "amount_um"))
          {
            if (file_.has_any(prefix))
              throw InputError(
                  fmt::format("{}: {}amount_um: missing; the other keys of this table say nothing without it",
                              file_.file(), prefix));
            return;
          }
        const auto [from, by_start] = start(prefix, roll_.start_of_active_profile, roll_.tip);
        const double rb = gear_.base_radius;
        const ReliefForm grows = form(prefix, amount(name), relief_gradient(rb, from, end));
        if (matters(amount(name)))
          add<ProfileRelief>({ by_amount(name)[0], by_start },
                             name == "tip_relief" ? "tip relief" : "root relief", amount(name), from, end,
                             grows, rb);
      }

      void end_relief()
      {
        const std::string prefix = table("end_relief") + ".";
        if (!file_.has(prefix + "amount_um"))
          return;
        const double a = amount("end_relief");
        const double length = file_.number(prefix + "length_mm");
        if (length > gear_.face_width)
          throw InputError(file_.place(prefix + "length_mm") +
                           fmt::format("longer than the face width {:.4f} mm", gear_.face_width));
        const std::string end = file_.text(prefix + "end");
        const int sign =
            end == "both" ? 0 : (end == "positive_z" ? 1 : -1) * static_cast<int>(along_z("end_relief.end"));
        const ReliefForm grows = form(prefix, a, 1 / length);
        if (matters(a))
          add<EndRelief>({ by_amount("end_relief")[0], { prefix + "length_mm", Parameter::length, {} } }, a,
                         length, gear_.face_width, sign, grows);
      }

      /// Corner 1 of the driving flank is where contact leaves its tip. In the canonical frame the contact
      /// lines run towards the tip as z grows, so that is the face end at -z; corners 1 to 4 of one gear meet
      /// 3, 4, 1, 2 of the other.
      void bias(const std::string &prefix)
      {
        const int corner = file_.integer(prefix + "corner");
        const bool at_tip = corner <= 2;
        const double end = at_tip ? roll_.tip : roll_.start_of_active_profile,
                     a = file_.number(prefix + "amount_um") * micrometre;
        const auto [from, by_start] =
            at_tip ? start(prefix, std::min(gear_.form_roll, roll_.start_of_active_profile), roll_.tip)
                   : start(prefix, roll_.start_of_active_profile, roll_.tip);
        const double length = file_.number(prefix + "length_mm");
        const double rb = gear_.base_radius;
        const ReliefForm grows = form(prefix, a, corner_gradient(rb, from, end, length));
        const bool drives = gear_.name == "pinion";
        const int canonical = (corner == 1 || corner == 4) == drives ? -1 : 1;
        // The loaded flank's contact lines; the coast flank's run the other way.
        const bool loaded = (flank_ == Flank::left) == pair_.data.counter_clockwise_drive;
        const int z_sign = static_cast<int>(canonical_z_sign(pair_.data)) * (loaded ? 1 : -1);
        if (matters(a))
          add<CornerBias>({ { prefix + "amount_um", Parameter::amount, { .factor = micrometre } },
                            by_start,
                            { prefix + "length_mm", Parameter::length, {} } },
                          corner, a, from, end, length, gear_.face_width, z_sign * canonical, grows, rb);
      }

      void single_teeth()
      {
        if (const std::string key = table("index_errors_um"); file_.has(key))
          {
            for (const double value : file_.numbers(key))
              result_.deviations.index_errors.push_back(value * micrometre);
            if (static_cast<int>(result_.deviations.index_errors.size()) != gear_.teeth)
              throw InputError(file_.place(key) + counted(result_.deviations.index_errors.size(), "number") +
                               fmt::format(" for {} teeth", gear_.teeth));
          }
        if (!file_.has(table("runout") + ".amount_um"))
          return;
        result_.deviations.runout = amount("runout");
        result_.deviations.runout_angle = file_.number(table("runout") + ".angle_deg") * degree;
      }

      const CaseFile &file_;
      const GearPair &pair_;
      const Gear &gear_;
      const RollAngles &roll_;
      Flank flank_;
      FlankInput result_;
    };
  } // namespace

  const char *name_of(const Flank flank)
  {
    return flank == Flank::left ? "left_flank" : "right_flank";
  }

  FlankInput read_flank(const CaseFile &file, const GearPair &pair, const Gear &gear, const RollAngles &roll,
                        const Flank flank)
  {
    return FlankReader(file, pair, gear, roll, flank).read();
  }
} // namespace flank
