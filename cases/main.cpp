// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/case_file.hpp"
#include "cases/report/make_report.hpp"
#include "cases/scene.hpp"
#include "cases/schema.hpp"
#include "cases/study/study.hpp"
#include "cases/versions.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"
#include "solver/parallel_session.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <malloc.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>
#include <string_view>
#include <thread>

namespace
{
  using namespace flank;

  Scene scene_of(const CaseFile &file)
  {
    return file.text("scene") == "parallel_axis" ? parallel_axis_scene() : double_roller_scene();
  }

  constexpr int stopped_by_signal = 4;

  /// "K/N", from 1.
  StudyPart part_of(const std::string &text)
  {
    int  number = 1, count = 1;
    char rest = 0;
    if (!text.empty() && (std::sscanf(text.c_str(), "%d/%d%c", &number, &count, &rest) != 2 || number < 1 || number > count))
      throw InputError(fmt::format("--part {}: must be K/N with K from 1 to N, such as 2/8", text));
    return { number - 1, count };
  }

  /// A run, or a part of a study; the exit code, which is that of rank 0.
  int run(const std::optional<StudyPart> &study, const std::string &path, std::string folder, const std::vector<std::string> &settings,
          const bool force, const bool resume, const ParallelSession &session)
  {
    const CaseFile file = CaseFile::read(path, settings);
    if (folder.empty())
      folder = "out/" + std::filesystem::path(path).stem().string();
    const ResultFolder results(folder, force);
    session.wait(); // the folder was looked at before anyone writes
    const Scene      scene = scene_of(file);
    const RunContext context{ results, session, versions(), resume };
    std::string      summary;
    int              exit_code = 0;
    if (study)
      {
        const StudyReport outcome = run_study(file, scene, context, *study);
        summary                   = outcome.summary;
        exit_code                 = outcome.stopped ? stopped_by_signal : outcome.failed > 0 ? 3 : 0;
      }
    else
      {
        if (file.has_study())
          spdlog::info("the case as it stands, without its [[study]] axes: flank study computes those");
        summary = scene.run(file, context);
      }
    if (session.rank() == 0)
      std::cout << "\n" << summary << "results in " << folder << "\n";
    return exit_code;
  }

  /// What one rank meets ends all of them. Wrong input is met by all, and said by rank 0.
  int run_on_ranks(const ParallelSession &session, const std::function<int()> &work)
  {
    const auto stop = [&](const char *what, const std::string &before, const int exit_code, const bool met_by_all) {
      if (session.rank() == 0 || !met_by_all)
        std::cerr << before << what << std::endl;
      else
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
      session.abort(exit_code);
    };
    try
      {
        return work();
      }
    catch (const InputError &error)
      {
        stop(error.what(), "", 2, true);
      }
    catch (const ComputationError &error)
      {
        stop(error.what(), "the computation failed, nothing was written: ", 3, false);
      }
    catch (const std::exception &error)
      {
        stop(error.what(), "internal error: ", 3, false);
      }
    return 3;
  }

  std::string check(const std::string &path, const std::vector<std::string> &settings)
  {
    const CaseFile file = CaseFile::read(path, settings);
    return scene_of(file).check(file);
  }

  /// Matrices of contact grids come and go: their memory is kept instead of given back and cleared again (4 % of a study). In a study it
  /// lies in large pages too (7 %), which the C library takes from the environment at its start alone: the program starts once more (1 ms).
  /// Elsewhere more would be cleared than used (1 s of the fields of a position).
  void set_up_memory(const int argc, char **argv)
  {
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    constexpr const char *tunables = "GLIBC_TUNABLES";
    if (argc < 2 || argv[1] != std::string_view("study") || std::getenv(tunables))
      return;
    std::error_code             error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    if (!error && setenv(tunables, "glibc.malloc.hugetlb=1", 0) == 0)
      execv(program.c_str(), argv); // returns only where it could not: then without
  }
} // namespace

int main(int argc, char **argv)
{
  set_up_memory(argc, argv);

  CLI::App app("flank: loaded tooth contact analysis of gear pairs.\nUnits are part of every key and column name; signs and conventions "
               "stand in README.md and at the head of every result.");
  app.require_subcommand(1);
  app.footer("Exit codes: 0 a certified result, 2 wrong input, 3 a computation that failed its certificate or did not "
             "converge (in a study: of some variant), 4 a study stopped by a signal.");
  std::string              path, folder, accuracy;
  std::vector<std::string> settings;
  bool                     force = false, resume = false, markdown = false;
  int                      ranks = 1;
  std::string              part;

  for (auto *command : { app.add_subcommand("run", "compute the loaded transmission error over a mesh cycle"),
                         app.add_subcommand("study", "all combinations of the case's [[study]] axes") })
    {
      command->add_option("CASE", path, "case file (TOML)")->required();
      command->add_option("-o", folder, "result folder (default out/<case name>)");
      command->add_option("--set", settings, "key=value, replaces the case file's")->allow_extra_args(false);
      command->add_option("--accuracy", accuracy, "draft, standard or reference");
      command->add_flag("--resume", resume, "go on with what a killed or stopped one of the same case left in the folder");
      command->add_flag("--force", force, "write into a folder that holds other files");
    }
  app.get_subcommand("study")->add_option("--part", part,
                                          "K/N: every N-th piece of it, for job arrays; all on the same folder, then --resume");
  auto *check_command = app.add_subcommand("check", "geometry and input report; computes nothing else");
  check_command->add_option("CASE", path, "case file (TOML)")->required();
  check_command->add_option("--set", settings, "key=value, replaces the case file's")->allow_extra_args(false);
  auto *plan_command =
      app.add_subcommand("plan", "what will be computed, what is left out and why, time and memory; computes nothing else");
  plan_command->add_option("CASE", path, "case file (TOML)")->required();
  plan_command->add_option("--set", settings, "key=value, replaces the case file's")->allow_extra_args(false);
  plan_command->add_option("--accuracy", accuracy, "draft, standard or reference");
  plan_command->add_option("--ranks", ranks, "MPI processes on this machine (default 1)")->check(CLI::Range(1, 1024));
  auto *schema_command = app.add_subcommand("schema", "every key: bounds, default, meaning");
  schema_command->add_flag("--markdown", markdown, "as the table of cases/README.md");
  app.add_subcommand("report", "figures and report.html of a result folder")
      ->add_option("DIR", folder, "folder of a run or a study")
      ->required();
  app.add_subcommand("about", "versions");
  try
    {
      app.parse(argc, argv);
    }
  catch (const CLI::ParseError &error)
    {
      return app.exit(error) == 0 ? 0 : 2;
    }

  spdlog::set_default_logger(spdlog::stderr_logger_mt("flank"));
  spdlog::set_pattern("%v");
  if (!accuracy.empty())
    settings.push_back("accuracy=" + accuracy);
  try
    {
      if (app.got_subcommand("report"))
        make_report(folder);
      else if (app.got_subcommand("about"))
        std::cout << versions();
      else if (app.got_subcommand("schema"))
        std::cout << schema_text(markdown);
      else if (app.got_subcommand("check"))
        std::cout << check(path, settings);
      else if (app.got_subcommand("plan"))
        {
          const CaseFile file = CaseFile::read(path, settings);
          share_cores(ranks);
          std::cout << scene_of(file).plan(file, ranks);
          if (file.has_study())
            std::cout << "\nflank study: " << plan_study(file, scene_of(file), ranks);
        }
      else
        {
          const auto            study        = app.got_subcommand("study") ? std::optional(part_of(part)) : std::nullopt;
          int                   no_arguments = 1;
          const ParallelSession session(no_arguments, argv);
          if (session.rank() > 0)
            spdlog::set_level(spdlog::level::off);
          if (session.ranks() == 1)
            return run(study, path, folder, settings, force, resume, session);
          return run_on_ranks(session, [&] { return run(study, path, folder, settings, force, resume, session); });
        }
    }
  catch (const InputError &error)
    {
      std::cerr << error.what() << "\n";
      return 2;
    }
  catch (const ComputationError &error)
    {
      std::cerr << "the computation failed, nothing was written: " << error.what() << "\n";
      return 3;
    }
  catch (const std::exception &error)
    {
      std::cerr << "internal error: " << error.what() << "\n";
      return 3;
    }
  return 0;
}
