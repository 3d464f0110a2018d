// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/case_file/case_file.hpp"
#include "cases/case_file/printable.hpp"
#include "cases/process.hpp"
#include "cases/report/make_report.hpp"
#include "cases/scenes.hpp"
#include "cases/study/study.hpp"
#include "cases/study/study_axes.hpp"
#include "cases/work/versions.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"
#include "solver/parallel_session.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <new>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>
#include <thread>

namespace
{
  using namespace flank;

  /// Writes messages to standard error, without characters that a terminal would act on.
  class PrintableSink : public spdlog::sinks::base_sink<std::mutex>
  {
    void sink_it_(const spdlog::details::log_msg &message) override
    {
      const std::string line =
          printable_line(std::string(message.payload.data(), message.payload.size())) + "\n";
      std::fwrite(line.data(), 1, line.size(), stderr);
      std::fflush(stderr);
    }
    void flush_() override { std::fflush(stderr); }
  };

  /// Writes a text to standard output. Throws std::system_error where that takes no more.
  void say(const std::string &text)
  {
    const std::string shown = printable(text);
    if (output_was_closed())
      throw std::system_error(EBADF, std::generic_category(), "cannot write to standard output");
    if (std::fwrite(shown.data(), 1, shown.size(), stdout) != shown.size() || std::fflush(stdout) != 0)
      throw std::system_error(errno, std::generic_category(), "cannot write to standard output");
  }

  /// The setting that --accuracy stands for: a level's name, or an error in percent such as "0.5%".
  std::string accuracy_setting(const std::string &text)
  {
    return text.ends_with('%') ? "accuracy.mean_te_percent=" + text.substr(0, text.size() - 1)
                               : "accuracy=" + text;
  }

  /// The part of a study that --part names: "K/N", K counted from 1. The whole for an empty text.
  StudyPart part_of(const std::string &text)
  {
    constexpr int most_parts = 999999999; // the digits of a part's files
    StudyPart part;
    const char *end = text.data() + text.size();
    const auto number = std::from_chars(text.data(), end, part.number);
    if (text.empty())
      return part;
    const auto count = number.ptr < end ? std::from_chars(number.ptr + 1, end, part.count) : number;
    if (number.ec != std::errc() || number.ptr == end || *number.ptr != '/' || count.ec != std::errc() ||
        count.ptr != end || part.number < 1 || part.number > part.count || part.count > most_parts)
      throw InputError(fmt::format("--part {}: must be K/N with K from 1 to N, N at most {}, such as 2/8",
                                   text.substr(0, 80), most_parts));
    --part.number;
    return part;
  }

  /// Reads a case and, where it has any, its [[study]] axes too, so that a mistake in them is refused even
  /// where they are not computed.
  CaseFile read_case(const std::string &path, const std::vector<std::string> &settings)
  {
    CaseFile file = CaseFile::read(schema(), path, settings);
    if (file.has_study())
      StudyAxes{ file };
    return file;
  }

  struct RunArguments
  {
    std::optional<StudyPart> study; ///< else a run
    std::string path, folder;
    std::vector<std::string> settings;
    bool force = false, resume = false;
  };

  /// Computes a run, a study or a part of one. Returns the exit code, which is that of rank 0.
  int run(const RunArguments &arguments, const ParallelSession &session)
  {
    available_threads(); // refuses what it cannot read before anything else is done
    const CaseFile file = read_case(arguments.path, arguments.settings);
    const std::string path = arguments.folder.empty()
                                 ? "out/" + std::filesystem::path(arguments.path).stem().string()
                                 : arguments.folder;
    const bool is_part = arguments.study && arguments.study->count > 1;
    const std::string part =
        is_part ? fmt::format("{}-of-{}", arguments.study->number + 1, arguments.study->count) : "";
    ResultFolder folder({ .path = path,
                          .command = arguments.study ? "study" : "run",
                          .program = versions().substr(0, versions().find('\n')),
                          .force = arguments.force,
                          .resume = arguments.resume,
                          .part = part,
                          .names = result_files() });
    const Scene &scene = scene_of(file);
    RunContext context = { .folder = folder,
                           .session = session,
                           .versions = versions(),
                           .goes_on = arguments.resume || is_part,
                           .failures = {},
                           .process = is_part ? part + "-" : "" };
    std::string summary;
    int exit_code = 0;
    if (arguments.study)
      {
        const StudyReport outcome = run_study(file, scene, context, *arguments.study);
        summary = outcome.summary;
        exit_code = outcome.stopped ? stopped_by_signal : context.failures.empty() ? 0 : 3;
      }
    else
      {
        if (file.has_study())
          spdlog::info("the case as it stands, without its [[study]] axes: flank study computes those");
        summary = scene.run(file, context);
        exit_code = context.failures.empty() ? 0 : 3;
      }
    if (session.rank() == 0)
      say("\n" + summary + "results in " + path + "\n");
    return exit_code;
  }

  /// What a command ends with, and the one line that says why.
  struct Failure
  {
    int exit_code;
    std::string line;
    bool met_by_all = false; ///< whether all ranks met it: wrong input, and what they told each other
  };

  Failure failure_of(const std::exception_ptr &thrown)
  {
    try
      {
        std::rethrow_exception(thrown);
      }
    catch (const InputError &error)
      {
        return { 2, error.what(), true };
      }
    catch (const ComputationError &error)
      {
        return { 3, std::string("the computation failed, nothing was written: ") + error.what(),
                 dynamic_cast<const SharedComputationError *>(&error) != nullptr };
      }
    catch (const OutputError &error)
      {
        return { 3, std::string(error.what()) + "; what was finished is kept: then go on with --resume" };
      }
    catch (const LibraryError &error)
      {
        return { 3, std::string(error.what()) + "; what was finished is kept: then go on with --resume" };
      }
    catch (const std::bad_alloc &)
      {
        return { 3, "out of memory: give the program more, or fewer threads (FLANK_THREADS), fewer contact "
                    "cells or a coarser mesh" };
      }
    catch (const std::system_error &error)
      {
        if (error.code() == std::errc::resource_unavailable_try_again)
          return { 3, "no further thread is to be had: give the program more processes (ulimit -u, the job's "
                      "limit)" };
        return { 3, error.what() };
      }
    catch (const std::exception &error)
      {
        return { 3, std::string("internal error: ") + error.what() };
      }
  }

  /// As run(). A failure that one rank meets ends all ranks; one that all meet, such as wrong input, is said
  /// by rank 0 alone.
  int run_on_ranks(const RunArguments &arguments, const ParallelSession &session)
  {
    if (session.ranks() == 1)
      return run(arguments, session);
    try
      {
        return run(arguments, session);
      }
    catch (...)
      {
        const Failure failure = failure_of(std::current_exception());
        if (session.rank() != 0 && failure.met_by_all)
          std::this_thread::sleep_for(std::chrono::seconds(10)); // rank 0 ends all before, unless it met none
        std::cerr << printable_line(failure.line) << std::endl;
        session.abort(failure.exit_code);
      }
  }

  std::string check(const std::string &path, const std::vector<std::string> &settings)
  {
    const CaseFile file = read_case(path, settings);
    return scene_of(file).check(file);
  }

  /// What the command line says.
  struct Command
  {
    RunArguments run;
    std::string accuracy, part;
    bool markdown = false;
    int ranks = 1;
  };

  /// --accuracy as a setting. Throws InputError where --set gives the same key.
  void add_accuracy(Command &command)
  {
    for (const std::string &setting : command.run.settings)
      if (setting.starts_with("accuracy=") || setting.starts_with("accuracy."))
        throw InputError(fmt::format("--accuracy {} and --set {}: both give the accuracy; leave one out",
                                     command.accuracy.substr(0, 80), setting.substr(0, 80)));
    command.run.settings.push_back(accuracy_setting(command.accuracy));
  }

  CLI::Validator not_empty()
  {
    return { [](const std::string &text) { return text.empty() ? std::string("is empty") : std::string(); },
             "" };
  }

  void declare_computations(CLI::App &app, Command &command)
  {
    auto &[study, path, folder, settings, force, resume] = command.run;
    for (auto *computation :
         { app.add_subcommand("run",
                              "compute a case: of gears the loaded transmission error over a mesh cycle"),
           app.add_subcommand("study", "all combinations of the case's [[study]] axes") })
      {
        computation->add_option("CASE", path, "case file (TOML)")->required();
        computation->add_option("-o", folder, "result folder (default out/<case name>)")->check(not_empty());
        computation
            ->add_option("--set", settings,
                         "key=value, replaces the case file's; of one key given twice the later holds")
            ->allow_extra_args(false);
        computation
            ->add_option("--accuracy", command.accuracy,
                         "draft, standard or reference; or what may be stated as the error of the mean "
                         "transmission error, such as 0.5%")
            ->check(not_empty());
        computation->add_flag("--resume", resume,
                              "go on with what a killed or stopped one of the same case left in the folder");
        computation->add_flag("--force", force,
                              "beside files that are no results, or in place of results of other inputs");
      }
    app.get_subcommand("study")
        ->add_option("--part", command.part,
                     "K/N: every N-th piece of it, for job arrays; all on the same folder, then --resume")
        ->check(not_empty());
  }

  void declare_others(CLI::App &app, Command &command)
  {
    auto &[study, path, folder, settings, force, resume] = command.run;
    auto *check = app.add_subcommand("check", "geometry and input report; computes nothing else");
    auto *plan = app.add_subcommand(
        "plan", "what will be computed, what is left out and why, time and memory; computes nothing else");
    for (auto *report : { check, plan })
      {
        report->add_option("CASE", path, "case file (TOML)")->required();
        report
            ->add_option("--set", settings,
                         "key=value, replaces the case file's; of one key given twice the later holds")
            ->allow_extra_args(false);
      }
    plan->add_option("--accuracy", command.accuracy, "draft, standard, reference or an error such as 0.5%")
        ->check(not_empty());
    plan->add_option("--ranks", command.ranks, "MPI processes on this machine (default 1)")
        ->check(CLI::Range(1, 1024));
    app.add_subcommand("schema", "every key: bounds, default, meaning")
        ->add_flag("--markdown", command.markdown, "as the table of cases/README.md");
    app.add_subcommand("report", "figures and report.html of a result folder")
        ->add_option("DIR", folder, "folder of a run or a study")
        ->required();
    app.add_subcommand("about", "versions");
  }

  std::string plan_text(const Command &command)
  {
    const CaseFile file = CaseFile::read(schema(), command.run.path, command.run.settings);
    share_cores(command.ranks);
    std::string text = scene_of(file).plan(file, command.ranks);
    if (file.has_study())
      text += "\nflank study: " + plan_study(file, scene_of(file), command.ranks);
    return text;
  }

  /// The exit code.
  int perform(const CLI::App &app, Command &command, char **argv)
  {
    require_limits();
    if (app.got_subcommand("report"))
      {
        say("");
        make_report(command.run.folder);
      }
    else if (app.got_subcommand("about"))
      say(versions());
    else if (app.got_subcommand("schema"))
      say(schema().text(command.markdown));
    else if (app.got_subcommand("check"))
      say(check(command.run.path, command.run.settings));
    else if (app.got_subcommand("plan"))
      say(plan_text(command));
    else
      {
        if (app.got_subcommand("study"))
          command.run.study = part_of(command.part);
        int no_arguments = 1;
        const ParallelSession session(no_arguments, argv);
        if (session.rank() > 0)
          spdlog::set_level(spdlog::level::off);
        return run_on_ranks(command.run, session);
      }
    return 0;
  }
} // namespace

int main(int argc, char **argv)
{
  set_up_process(argc, argv);

  CLI::App app("flank: loaded tooth contact analysis of gear pairs.\nUnits are part of every key and column "
               "name; signs and conventions stand in README.md and at the head of every result.");
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 a certified result, 2 wrong input (nothing written), 3 a computation that failed "
      "its certificate or did not converge (of some torque, in a study of some variant: the others are "
      "written), or results that cannot be written, 4 stopped by a signal (--resume goes on).\n"
      "Environment: FLANK_THREADS, threads of a process (default: its share of the cores); "
      "FLANK_CACHE, folder of reduced bodies.");
  Command command;
  declare_computations(app, command);
  declare_others(app, command);
  std::optional<std::string> help;
  try
    {
      app.parse(argc, argv);
    }
  catch (const CLI::ParseError &error)
    {
      std::ostringstream out, err;
      if (app.exit(error, out, err) != 0)
        {
          std::cerr << printable_line(err.str() + out.str()) << "\n";
          return 2;
        }
      help = out.str();
    }

  spdlog::set_default_logger(std::make_shared<spdlog::logger>("flank", std::make_shared<PrintableSink>()));
  try
    {
      if (!command.accuracy.empty())
        add_accuracy(command);
      if (!help)
        return perform(app, command, argv);
      say(*help);
    }
  catch (...)
    {
      const Failure failure = failure_of(std::current_exception());
      std::cerr << printable_line(failure.line) << "\n";
      return failure.exit_code;
    }
  return 0;
}
