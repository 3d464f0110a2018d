// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/study/study.hpp"

#include "cases/journal.hpp"
#include "cases/packing.hpp"
#include "cases/study/study_axes.hpp"
#include "cases/study/study_results.hpp"
#include "cases/study/study_work.hpp"
#include "cases/versions.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"
#include "solver/parallel_session.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <iterator>

namespace flank
{
  namespace
  {
    volatile std::sig_atomic_t stop_asked = 0;

    /// While it lives, SIGINT, SIGTERM and SIGUSR1 (the one that mpirun hands on to its processes without ending them) ask for a stop after
    /// the pieces in work.
    class StopOnSignal
    {
    public:
      StopOnSignal()
      {
        struct sigaction action = {};
        action.sa_handler       = [](int) { stop_asked = 1; };
        for (std::size_t k = 0; k < std::size(signals); ++k)
          sigaction(signals[k], &action, &before_[k]);
      }
      ~StopOnSignal()
      {
        for (std::size_t k = 0; k < std::size(signals); ++k)
          sigaction(signals[k], &before_[k], nullptr);
      }
      StopOnSignal(const StopOnSignal &) = delete;

    private:
      static constexpr int signals[]                   = { SIGINT, SIGTERM, SIGUSR1 };
      struct sigaction     before_[std::size(signals)] = {};
    };

    std::uint64_t piece_id(const int stage, const std::size_t piece)
    {
      return static_cast<std::uint64_t>(stage) << 40 | piece;
    }

    std::vector<char> pack(const std::vector<StudyOutcome> &outcomes)
    {
      Packer out;
      for (const StudyOutcome &outcome : outcomes)
        {
          out.values(std::vector<char>(outcome.failure.begin(), outcome.failure.end()));
          out.values(outcome.points);
          out.values(outcome.derivatives);
        }
      return std::move(out.result);
    }

    std::string in_words(const double seconds)
    {
      return seconds < 120    ? fmt::format("{:.0f} s", seconds)
             : seconds < 7200 ? fmt::format("{:.0f} min", seconds / 60)
                              : fmt::format("{:.1f} h", seconds / 3600);
    }
  } // namespace

  StudyReport run_study(const CaseFile &file, const Scene &scene, const RunContext &context, const StudyPart &part)
  {
    const ParallelSession &session = context.session;
    const int              rank    = session.rank();
    const bool             resume  = context.resume || part.count > 1;
    const StudyAxes        axes(file);
    const auto             work = scene.study(axes);
    if (rank == 0)
      context.folder.begin(resume);
    session.wait();
    Journal journal(context.folder.path(), file.resolved() + axes.text() + work->files() + operator_sources(),
                    part.count > 1 ? fmt::format("{}-{}", part.number, rank) : std::to_string(rank), resume);
    session.wait(); // every rank has read what there was

    const StopOnSignal stop_on_signal;
    long               all = 0, done = 0;
    for (int stage = 0; stage < work->n_stages(); ++stage)
      all += static_cast<long>(work->pieces(stage).size());
    const auto start   = std::chrono::steady_clock::now();
    long       begun   = 0; // pieces of this call, in earlier stages
    bool       stopped = false;
    for (int stage = 0; stage < work->n_stages() && !stopped; ++stage)
      {
        std::vector<std::size_t> left; // the same list on every rank
        const auto              &pieces = work->pieces(stage);
        for (std::size_t k = 0; k < pieces.size(); ++k)
          if (journal.holds(piece_id(stage, k)))
            ++done;
          else if (static_cast<int>(k % part.count) == part.number)
            left.push_back(k);
        if (left.empty())
          continue;
        work->prepare(stage, session);
        SharedCounter     counter(session);
        std::atomic<long> shown{ 0 };
        const auto        n = static_cast<long>(left.size());
        parallel_for(available_threads(), [&](int) {
          while (!stop_asked)
            {
              const long k = counter.next();
              if (k >= n)
                return;
              journal.append(piece_id(stage, left[k]), pack(work->solve(pieces[left[k]])));
              // The counter tells how far all ranks are.
              if (const long tenth = 50 * k / n; rank == 0 && shown.exchange(tenth) != tenth)
                {
                  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
                  spdlog::info("study: {} of {} pieces, about {} left", done + k, all,
                               in_words(seconds / static_cast<double>(begun + k + 1) * static_cast<double>(all - done - k)));
                }
            }
        });
        stopped = session.any(stop_asked != 0); // every rank is here: all pieces are in the journals
        done += n;
        begun += n;
      }
    session.wait();

    StudyReport result;
    result.variants = axes.n_variants();
    result.stopped  = stopped;
    if (rank != 0)
      return result;
    journal.reread();
    if (stopped)
      {
        result.summary = fmt::format("stopped: {} of {} pieces are done; go on with --resume\n", journal.found(), all);
        return result;
      }
    if (part.count > 1)
      {
        result.summary =
            fmt::format("part {} of {} is done, {} of {} pieces of all parts; when all are, flank study --resume makes the tables\n",
                        part.number + 1, part.count, journal.found(), all);
        return result;
      }
    StudyTable table(axes, *work);
    for (int stage = 0; stage < work->n_stages(); ++stage)
      for (std::size_t k = 0; k < work->pieces(stage).size(); ++k)
        {
          const StudyPiece       &piece = work->pieces(stage)[k];
          const std::vector<char> bytes = journal.find(piece_id(stage, k)).value();
          Unpacker                in(bytes);
          for (const long variant : piece.variants)
            {
              const auto   reason = in.values<char>();
              StudyOutcome outcome{ std::string(reason.begin(), reason.end()), in.values<StudyPoint>(), in.values<double>() };
              table.add(variant, piece.positions, std::move(outcome));
            }
        }
    result.failed  = table.failed();
    result.summary = table.write(context.folder, file, context.versions);
    Journal::remove(context.folder.path());
    return result;
  }

  std::string plan_study(const CaseFile &file, const Scene &scene, const int processes)
  {
    const StudyAxes axes(file);
    return fmt::format("{} variants of {} keys\n", axes.n_variants(), axes.keys().size()) + scene.study(axes)->plan(processes);
  }
} // namespace flank
