// SPDX-License-Identifier: GPL-2.0-or-later
// Run times of the contact solver on three contact lines, n = 198 to 4950, beside their floors.
#include "contact/solve/certificate.hpp"
#include "contact/solve/simplex_solver.hpp"
#include "tests/contact/problem_zoo.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>

namespace
{
  using namespace flank;

  struct Prepared
  {
    zoo::Specimen specimen;
    ContactSolution solution;
    std::vector<int> neighbour; ///< active cells of the next mesh position, the most loaded first: gaps moved
                                ///< by a part of a cell
  };

  /// A wide grid: about three cells of ten are active, as in the figures to compare with.
  const Prepared &prepared(const int n)
  {
    static std::map<int, Prepared> all;
    if (const auto it = all.find(n); it != all.end())
      return it->second;
    Prepared p{ zoo::contact_lines(3, n / 33, 11, 200e3, 2.8), {}, {} };
    p.solution = SimplexSolver(p.specimen.problem).solve(p.specimen.torque);
    ContactProblem next = p.specimen.problem;
    for (Eigen::Index i = 0; i < next.size(); ++i)
      next.gap[i] += 2e-5 * static_cast<double>(i % 11);
    const ContactSolution beside = SimplexSolver(next).solve(p.specimen.torque);
    p.neighbour = beside.active;
    std::sort(p.neighbour.begin(), p.neighbour.end(),
              [&](int a, int b) { return beside.force[a] > beside.force[b]; });
    if (!certify(p.specimen.problem, p.solution).holds())
      std::abort();
    return all.emplace(n, std::move(p)).first->second;
  }

  void count(benchmark::State &state, const Prepared &p)
  {
    state.counters["active"] = static_cast<double>(p.solution.active.size());
  }

  void cold(benchmark::State &state)
  {
    const Prepared &p = prepared(static_cast<int>(state.range(0)));
    SimplexSolver solver;
    ContactSolution s;
    for (auto _ : state)
      {
        solver.set(p.specimen.problem);
        solver.solve(p.specimen.torque, {}, s);
      }
    count(state, p);
  }

  void warm(benchmark::State &state)
  {
    const Prepared &p = prepared(static_cast<int>(state.range(0)));
    SimplexSolver solver;
    ContactSolution s;
    for (auto _ : state)
      {
        solver.set(p.specimen.problem);
        solver.solve(p.specimen.torque, p.neighbour, s);
      }
    count(state, p);
  }

  void hundred_torques(benchmark::State &state)
  {
    const Prepared &p = prepared(static_cast<int>(state.range(0)));
    SimplexSolver solver;
    std::vector<double> torques;
    for (int i = 1; i <= 100; ++i)
      torques.push_back(p.specimen.torque * i / 100);
    for (auto _ : state)
      {
        solver.set(p.specimen.problem);
        benchmark::DoNotOptimize(solver.sweep(torques, p.neighbour));
      }
    count(state, p);
  }

  void finite_path(benchmark::State &state)
  {
    const Prepared &p = prepared(static_cast<int>(state.range(0)));
    SimplexSolver solver;
    for (auto _ : state)
      {
        solver.set(p.specimen.problem);
        benchmark::DoNotOptimize(solver.solve_by_path(p.specimen.torque));
      }
    count(state, p);
  }

  void floor_cholesky(benchmark::State &state)
  {
    const Prepared &p = prepared(static_cast<int>(state.range(0)));
    const Eigen::MatrixXd block = p.specimen.problem.compliance(p.solution.active, p.solution.active);
    Eigen::MatrixXd copy = block;
    for (auto _ : state)
      {
        copy = block;
        const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(copy);
        benchmark::DoNotOptimize(copy.data());
      }
    count(state, p);
  }

  void floor_product(benchmark::State &state)
  {
    const Prepared &p = prepared(static_cast<int>(state.range(0)));
    Eigen::VectorXd w;
    for (auto _ : state)
      {
        w.noalias() = p.specimen.problem.compliance * p.solution.force;
        benchmark::DoNotOptimize(w.data());
      }
    count(state, p);
  }
} // namespace

#define SIZES Arg(198)->Arg(495)->Arg(990)->Arg(1980)->Arg(4950)->Unit(benchmark::kMillisecond)
BENCHMARK(floor_cholesky)->SIZES;
BENCHMARK(floor_product)->SIZES;
BENCHMARK(cold)->SIZES;
BENCHMARK(warm)->SIZES;
BENCHMARK(hundred_torques)->SIZES;
BENCHMARK(finite_path)->SIZES;
BENCHMARK_MAIN();
