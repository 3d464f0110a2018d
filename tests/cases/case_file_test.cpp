// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/case_file/case_file.hpp"
#include "cases/case_file/toml_text.hpp"
#include "cases/case_file/value.hpp"
#include "cases/parallel_axis/geometry_report.hpp"
#include "cases/parallel_axis/whole_case.hpp"
#include "cases/scenes.hpp"
#include "tests/messages.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

using namespace flank;

namespace
{
  const std::string root = FLANK_ROOT;

  /// The message a changed helical case is refused with; empty if it is accepted.
  std::string refusal(const std::vector<std::string> &settings, const std::string &added = "")
  {
    const std::string path = (std::filesystem::path(testing::TempDir()) / "case_file_test.toml").string();
    std::ifstream source(root + "/cases/parallel_axis/helical.toml");
    std::ofstream(path) << source.rdbuf() << added;
    return refusal_of([&] { read_parallel_axis(CaseFile::read(schema(), path, settings)); });
  }
} // namespace

TEST(CaseFile, EveryReadyCaseIsAccepted)
{
  int count = 0;
  for (const auto &entry : std::filesystem::directory_iterator(root + "/cases/parallel_axis"))
    if (entry.path().extension() == ".toml")
      {
        EXPECT_NO_THROW(geometry_report(read_parallel_axis(CaseFile::read(schema(), entry.path().string()))))
            << entry.path();
        ++count;
      }
  EXPECT_GE(count, 5);
}

TEST(CaseFile, MessagesNameFileLineKeyValueAndRemedy)
{
  EXPECT_EQ(refusal({}), "");
  const std::string unknown = refusal({}, "\n[mesh]\nflank_row = 3\n");
  EXPECT_TRUE(
      holds(unknown, { "case_file_test.toml:", "mesh.flank_row = 3", "unknown key", "mesh.flank_rows" }))
      << unknown;
  EXPECT_TRUE(
      holds(refusal({}, "\n[contact]\nsplit = \"magic\"\n"), { "contact.split", "magic", "projected" }));
  EXPECT_TRUE(
      holds(refusal({ "pinion.teeth=50.5" }), { "--set", "pinion.teeth = 50.5", "not an integer", "6" }));
  EXPECT_TRUE(holds(refusal({ "pinion.youngs_modulus_GPa=nan" }),
                    { "pinion.youngs_modulus_GPa", "not a finite number" }));
  EXPECT_TRUE(holds(refusal({ "pinion.youngs_modulus_GPa=inf" }), { "not a finite number" }));
  EXPECT_TRUE(holds(refusal({ "load.pinion_torque_Nm=[-1]" }), { "load.pinion_torque_Nm", "out of bounds" }));
  EXPECT_TRUE(holds(refusal({ "pair.normal_module_mm=3" }), { "pair.", "contradicts" }));
  EXPECT_TRUE(holds(refusal({ "pinion.tip_relief.start_roll_angle_deg=40" }),
                    { "pinion.tip_relief.start_roll_angle_deg", "27.17" }));
  EXPECT_TRUE(
      holds(refusal({ "gear.bore_diameter_mm=140" }), { "gear.bore_diameter_mm = 140", "bore too large" }));
  EXPECT_TRUE(holds(refusal({ "contact_grid.profile_cells=10" }), { "odd" }));
  EXPECT_TRUE(holds(refusal({}, "\nthis is not toml"), { "not valid TOML", ":" }));
  EXPECT_THROW(CaseFile::read(schema(), "/nowhere/case.toml"), InputError);
}

TEST(CaseFile, LettersOfAllLanguagesStandInTextsAndCommentsAlone)
{
  for (const std::string right : { "# Zähne\n", "[a] # \"ä\n", "t = \"ä \\\" ö\" # ü\n", "t = 'ä\\' # ö\n",
                                   "t = \"\"\"ä \"\" \n ö \\\"\"\"\"\"\"\n", "t = '''ä\n\\'''\n" })
    EXPECT_EQ(refusal({}, "\n" + right).find("plain ASCII"), std::string::npos) << right;
  for (const std::string wrong : { "ä = 3\n", "[ä]\n", "t = \"\"\"a\"\"\"\"\" ö\n", "t = 3 \u00a0\n",
                                   "t = 'a\\' ö\n", "t = \"a\nö\"\n" })
    EXPECT_NE(refusal({}, "\n" + wrong).find("plain ASCII"), std::string::npos) << wrong;
  EXPECT_EQ(refusal({ "title=Zähne" }), "");
  EXPECT_TRUE(holds(refusal({ "pinion.teeth=3ö" }), { "--set", "pinion.teeth", "plain ASCII" }));
}

TEST(CaseFile, ValuesAreWrittenAsTheyAreRead)
{
  const std::string text = "a = [ 0.01, -2.5, 3, \"x\" ]\nb = [  ]\nc = { \"k k\" = 1, k = [ [ 1e-300 ] ] "
                           "}\nd = 1e+22\ne = true\n";
  const auto table = toml::parse(text);
  EXPECT_EQ(toml_text(*table.get("a")), "[ 0.01, -2.5, 3, \"x\" ]");
  EXPECT_EQ(toml_text(*table.get("b")), "[]");
  for (const auto &[key, node] : table)
    {
      const auto again = toml::parse("x = " + toml_text(node));
      EXPECT_EQ(toml_text(*again.get("x")), toml_text(node));
    }
  EXPECT_TRUE(*toml::parse("x = " + toml_text(*table.get("c"))).get("x")->as_table() ==
              *table.get("c")->as_table());
}

TEST(CaseFile, WhatIsPlainlyAllowedIsTaken)
{
  const CaseFile file = CaseFile::read(schema(), root + "/cases/parallel_axis/helical.toml");
  int plain = 0;
  for (const std::string key : { "title", "pinion.teeth", "pinion.poissons_ratio", "load.pinion_torque_Nm",
                                 "body.model", "output.fields", "pinion.lead_crown.amount_um" })
    for (const std::string text :
         { "",       "0",        "-0",       "+7",    "07",  "50",   "50.0",     "5e1",
           "-3",     "-3.5",     ".5",       "5.",    "0.3", "1e",   "1e-400",   "1e400",
           "0x10",   "1_0",      "inf",      "nan",   " 7",  "7 ",   "7#",       "[ 7, 8 ]",
           "[ 7, ]", "[ 7 8 ]",  "[  ]",     "[ 7 ]", "[7]", "ring", "\"ring\"", "'ring'",
           "\"",     "\"a\"b\"", "a\\u001b", "{a=1}", "ä",   "a\tb", "a#b c",    "12345678901234567890" })
      if (is_plainly_allowed(*schema().find(key), text))
        {
          ++plain;
          EXPECT_NO_THROW(file.check({ key + "=" + text }, "test")) << key << " = " << text;
        }
  EXPECT_GE(plain, 30);
}

TEST(CaseFile, SettingsReplaceAndLikeCopies)
{
  const CaseFile file =
      CaseFile::read(schema(), root + "/cases/parallel_axis/helical.toml",
                     { "pinion.teeth=49", "gear.teeth=51", "title=changed", "pair.pinion_hand=left" });
  EXPECT_EQ(file.integer("pinion.teeth"), 49);
  EXPECT_EQ(file.integer("gear.teeth"), 51);
  EXPECT_EQ(file.number("gear.face_width_mm"), 20);
  EXPECT_EQ(file.text("title"), "changed");
  EXPECT_EQ(file.text("pair.pinion_hand"), "left");
}

TEST(CaseFile, WhatAGearSaysOfBothFlanksIsNotCopiedOfOne)
{
  const std::string helical = root + "/cases/parallel_axis/helical.toml",
                    of_one = "pinion.left_flank.tip_relief.amount_um=20",
                    start = "pinion.left_flank.tip_relief.start_roll_angle_deg=22.2";
  EXPECT_EQ(
      CaseFile::read(schema(), helical, { of_one, start }).number("gear.left_flank.tip_relief.amount_um"),
      20);
  const CaseFile own = CaseFile::read(schema(), helical, { of_one, start, "gear.tip_relief.amount_um=3" });
  EXPECT_FALSE(own.has("gear.left_flank.tip_relief.amount_um"));
  EXPECT_FALSE(own.has("gear.left_flank.tip_relief.start_roll_angle_deg"));
  EXPECT_EQ(own.number("gear.tip_relief.amount_um"), 3);
  EXPECT_TRUE(own.copied("gear.lead_crown.amount_um"));
}

TEST(CaseFile, SettingsStandAboveTheSourceThatResultsKeep)
{
  const std::string helical = root + "/cases/parallel_axis/helical.toml";
  const CaseFile plain = CaseFile::read(schema(), helical);
  EXPECT_EQ(plain.source_with_settings(), plain.source());
  const std::string text =
      plain.with({ "accuracy=draft" }, "test").with({ "pinion.teeth=49" }, "test").source_with_settings();
  EXPECT_TRUE(text.ends_with(plain.source()));
  EXPECT_LT(text.find("#   accuracy=draft\n"), text.find("#   pinion.teeth=49\n"));
  EXPECT_NO_THROW(CaseFile::of_text(schema(), text, "again"));
  const CaseFile marked =
      CaseFile::of_text(schema(), "\xEF\xBB\xBF" + plain.source(), "marked", { "pinion.teeth=49" });
  EXPECT_NO_THROW(CaseFile::of_text(schema(), marked.source_with_settings(), "again"));
}

TEST(CaseFile, AGivenValueIsAnotherInputThanACopiedOne)
{
  // gear.like mirrors what lies along the face; the same value given for the gear is not mirrored.
  const std::string helical = root + "/cases/parallel_axis/helical.toml",
                    given = "pinion.helix_slope.amount_um=6";
  const CaseFile copied = CaseFile::read(schema(), helical, { given }),
                 explicitly = CaseFile::read(schema(), helical, { given, "gear.helix_slope.amount_um=6" });
  ASSERT_EQ(copied.number("gear.helix_slope.amount_um"), 6);
  EXPECT_NE(copied.inputs(), explicitly.inputs());
  EXPECT_NE(copied.inputs().find("gear.like = \"pinion\""), std::string::npos);
  // What is resolved is the same case again.
  const CaseFile again = CaseFile::of_text(schema(), copied.resolved(), "again", {});
  EXPECT_TRUE(again.copied("gear.helix_slope.amount_um"));
  EXPECT_EQ(again.inputs(), copied.inputs());
  // So it is for every key that a copy rule may copy: none that is copied stands among the inputs.
  for (const std::string &key : copied.keys_ending_with(""))
    EXPECT_EQ(("\n" + copied.inputs()).find("\n" + key + " = ") == std::string::npos, copied.copied(key))
        << key;
}

TEST(CaseFile, AFileThatAKeyNamesIsReadOnce)
{
  const std::string folder = testing::TempDir() + "named_files";
  std::filesystem::create_directories(folder);
  const auto write = [&](const char *name, const char *text) { std::ofstream(folder + "/" + name) << text; };
  std::filesystem::remove(folder + "/b.csv");
  write("a.csv", "first");
  std::ifstream stream(root + "/cases/parallel_axis/helical.toml");
  const std::string text((std::istreambuf_iterator<char>(stream)), {});
  const auto read = [&] {
    return CaseFile::of_text(schema(), text, folder + "/case.toml", { "pinion.topography.file=a.csv" });
  };
  const CaseFile file = read(), other = file.with({ "pinion.topography.file=b.csv" }, "test");
  EXPECT_EQ(file.text_of_file("pinion.topography.file"), "first");
  EXPECT_THROW(other.text_of_file("pinion.topography.file"), InputError);
  const std::string before = file.files_read();
  EXPECT_NE(before.find("file a.csv: "), std::string::npos);
  EXPECT_NE(before.find("file b.csv: cannot be read"), std::string::npos);
  write("a.csv", "second");
  write("b.csv", "first");
  // Whoever is made from the case sees what it saw, and what could not be read then cannot be now.
  EXPECT_EQ(file.with({}, "test").text_of_file("pinion.topography.file"), "first");
  EXPECT_THROW(file.with({ "pinion.topography.file=b.csv" }, "test").text_of_file("pinion.topography.file"),
               InputError);
  EXPECT_EQ(other.files_read(), before);
  // A case that is read anew does not; contents are told by their names.
  EXPECT_EQ(read().text_of_file("pinion.topography.file"), "second");
  const CaseFile exchanged = read();
  exchanged.text_of_file("pinion.topography.file");
  write("a.csv", "first");
  const CaseFile again = read();
  again.text_of_file("pinion.topography.file");
  EXPECT_NE(exchanged.files_read(), again.files_read());
}

TEST(Schema, KeyTableOfTheReadmeIsTheSchema)
{
  std::ifstream stream(root + "/cases/README.md");
  const std::string readme((std::istreambuf_iterator<char>(stream)), {});
  EXPECT_NE(readme.find(schema().text(true)), std::string::npos) << "renew it with: flank schema --markdown";
}
