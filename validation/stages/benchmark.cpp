// SPDX-License-Identifier: GPL-2.0-or-later
// Run times of the stages of a parallel-axis scene on the helical pair of Wagaj and Kahraman, and how they
// grow.
#include "cases/parallel_axis/pair/mesh_cycle.hpp"
#include "contact/solve/simplex_solver.hpp"
#include "solver/linear/direct_solver.hpp"
#include "solver/parallel_session.hpp"
#include "solver/reduction/tooth_responses.hpp"
#include "tests/example_pairs.hpp"

#include <benchmark/benchmark.h>

#include <numeric>

using namespace flank;

namespace
{
  const GearPair &pair()
  {
    static const GearPair p = make_gear_pair(paper_pair(25.232));
    return p;
  }

  /// Levels 0, 1, 2: draft, standard, reference.
  SectorResolution mesh(const int level)
  {
    SectorResolution size;
    size.flank_rows = std::array{ 6, 9, 13 }[level];
    size.tooth_columns = std::array{ 4, 6, 8 }[level];
    size.face_layers = std::array{ 6, 10, 16 }[level];
    size.rim_layers = std::array{ 5, 7, 9 }[level];
    size.fillet_rows = size.fillet_columns = level == 2 ? 3 : 2;
    return size;
  }

  const BodyElements &elements(const int level)
  {
    static std::unique_ptr<BodyElements> made[3];
    if (!made[level])
      made[level] = std::make_unique<BodyElements>(pair().pinion, mesh(level));
    made[level]->blocks();
    return *made[level];
  }

  const BodyCompliance &body()
  {
    static const BodyCompliance b(pair().pinion, mesh(1), 6);
    return b;
  }

  LoadedPair loaded(const int slices, const int cells)
  {
    return { .bodies = { .pair = pair(),
                         .pinion = body(),
                         .gear = body(),
                         .grid = { slices, cells },
                         .pinion_mounting = {},
                         .gear_mounting = {} },
             .deviations = {} };
  }

  void unknowns(benchmark::State &state, const int level)
  {
    state.counters["unknowns"] = elements(level).body().n_unknowns();
  }

  void mesh_and_elements(benchmark::State &state)
  {
    const int level = static_cast<int>(state.range(0));
    for (auto _ : state)
      benchmark::DoNotOptimize(BodyElements(pair().pinion, mesh(level)).body().n_unknowns());
    unknowns(state, level);
  }

  void assembly(benchmark::State &state)
  {
    const int level = static_cast<int>(state.range(0));
    for (auto _ : state)
      benchmark::DoNotOptimize(elements(level).body().stiffness().nonZeros());
    unknowns(state, level);
  }

  void condensation(benchmark::State &state)
  {
    const int level = static_cast<int>(state.range(0));
    for (auto _ : state)
      benchmark::DoNotOptimize(
          condense_sector(elements(level).sector(), elements(level).body(), MidPlane::none, 0, nullptr)
              .own.sum());
    unknowns(state, level);
  }

  void closing(benchmark::State &state)
  {
    const int level = static_cast<int>(state.range(0));
    const bool ring = state.range(1) == 0;
    const CondensedSector sector =
        condense_sector(elements(level).sector(), elements(level).body(), MidPlane::none, 0, nullptr);
    for (auto _ : state)
      benchmark::DoNotOptimize(
          (ring ? ring_responses(sector, 50, 6) : segment_responses(sector, 7, false, 6))[0].sum());
    unknowns(state, level);
  }

  void near_field_tables(benchmark::State &state)
  {
    const int level = static_cast<int>(state.range(0));
    for (auto _ : state)
      {
        const auto &e = elements(level);
        ProjectedSplit split(pair().pinion, flank_surface(e.sector()), 5,
                             [&]() -> const FlankBlocks & { return e.blocks(); });
        split.prepare(available_threads() - 1)->finish();
        benchmark::DoNotOptimize(split.tables().size());
      }
    unknowns(state, level);
  }

  /// One mesh position: grid and compliance, then a sweep of as many torques as asked for.
  void position(benchmark::State &state)
  {
    const LoadedPair mesh = loaded(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
    std::vector<double> torques(state.range(2));
    for (std::size_t i = 0; i < torques.size(); ++i)
      torques[i] = 300e3 * (1 - 0.5 * static_cast<double>(i) / static_cast<double>(torques.size()));
    int cells = 0;
    for (auto _ : state)
      cells = mesh.solve(0.3, torques)[0].cells;
    state.counters["cells"] = cells;
  }

  /// Compliance of one grid alone.
  void compliance(benchmark::State &state)
  {
    const LoadedPair mesh = loaded(static_cast<int>(state.range(0)), 11);
    const SlicedPosition at = mesh.at(0.3);
    std::size_t cells = 0;
    for (auto _ : state)
      {
        PositionCompliance compliance(mesh.bodies.pinion, mesh.bodies.gear, pair().pinion.flank());
        PositionGrid grid(mesh.bodies, at.position, compliance, at.in_reach(0.05), 0, 300e3);
        grid.build(grid.windows());
        cells = grid.cells().size();
      }
    state.counters["cells"] = static_cast<double>(cells);
  }

  void contact_and_certificate(benchmark::State &state)
  {
    const LoadedPair mesh = loaded(static_cast<int>(state.range(0)), 11);
    const SlicedPosition at = mesh.at(0.3);
    PositionCompliance compliance(mesh.bodies.pinion, mesh.bodies.gear, pair().pinion.flank());
    PositionGrid grid(mesh.bodies, at.position, compliance, at.in_reach(0.05), 0, 300e3);
    grid.build(grid.windows());
    const ContactProblem &problem = grid.problem();
    const std::vector<int> start = grid.expected_contact();
    for (auto _ : state)
      {
        const auto solutions = SimplexSolver(problem).sweep({ 300e3, 250e3, 200e3, 150e3 }, start);
        for (const ContactSolution &solution : solutions)
          if (!certify(problem, solution).holds())
            state.SkipWithError("certificate");
      }
    state.counters["cells"] = static_cast<double>(grid.cells().size());
  }
} // namespace

BENCHMARK(mesh_and_elements)->DenseRange(0, 2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(assembly)->DenseRange(0, 2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(condensation)->DenseRange(0, 2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(closing)->ArgsProduct({ { 0, 1, 2 }, { 0, 1 } })->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(near_field_tables)->DenseRange(0, 2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(compliance)->Arg(21)->Arg(41)->Arg(81)->Arg(161)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(contact_and_certificate)
    ->Arg(21)
    ->Arg(41)
    ->Arg(81)
    ->Arg(161)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(position)
    ->ArgsProduct({ { 41 }, { 11 }, { 1, 4, 16, 64 } })
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

int main(int argc, char **argv)
{
  benchmark::Initialize(&argc, argv);
  const ParallelSession session(argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
