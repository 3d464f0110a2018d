// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/contact/problem_zoo.hpp"

#include "contact/half_space/half_space.hpp"

#include <cmath>
#include <random>

namespace flank::zoo
{
  namespace
  {
    constexpr double surface = 2 * 1.4e-6; // (1 - nu^2)/(pi E) of two steel bodies [mm^2/N]

    /// Cells on a line of slices along y and cells along x.
    ContactProblem patch(const int slices, const int across, const double length, const double width,
                         const double radius, const double crown)
    {
      const double a = width / across, b = length / slices / 2;
      std::vector<half_space::Rectangle> cells;
      for (int s = 0; s < slices; ++s)
        for (int c = 0; c < across; ++c)
          cells.push_back({ (2 * c + 1 - across) * a, (2 * s + 1 - slices) * b, a, b });
      const auto n = static_cast<Eigen::Index>(cells.size());
      ContactProblem p;
      p.compliance.resize(n, n);
      p.gap.resize(n);
      p.lever = Eigen::VectorXd::Constant(n, 64.4);
      for (Eigen::Index i = 0; i < n; ++i)
        {
          p.gap[i] = cells[i].x * cells[i].x / (2 * radius) + crown * std::pow(2 * cells[i].y / length, 2);
          for (Eigen::Index j = 0; j <= i; ++j)
            p.compliance(i, j) = p.compliance(j, i) =
                surface *
                half_space::love_potential({ 0, 0, a, b }, cells[i].x - cells[j].x, cells[i].y - cells[j].y);
        }
      return p;
    }
  } // namespace

  Specimen contact_lines(const int lines, const int slices, const int across, const double torque,
                         const double window)
  {
    // Hertz half-width of the most loaded line, with a 60 % share.
    const double length = 20, radius = 10, load = torque / 64.4 / length * 0.6,
                 effective = 1 / (3.14159265358979 * surface);
    const double width = window * std::sqrt(4 * load * radius / (3.14159265358979 * effective));
    const ContactProblem line = patch(slices, across, length, width, radius, 0.002);
    const Eigen::Index m = line.size(), n = lines * m;
    Specimen s{ "three contact lines", {}, torque };
    s.problem.compliance.resize(n, n);
    s.problem.gap.resize(n);
    s.problem.lever.resize(n);
    for (int a = 0; a < lines; ++a)
      {
        s.problem.gap.segment(a * m, m) = line.gap.array() + 0.001 * std::abs(a - lines / 2);
        s.problem.lever.segment(a * m, m) = line.lever;
        for (int b = 0; b < lines; ++b)
          {
            auto c = s.problem.compliance.block(a * m, b * m, m, m);
            c = a == b ? line.compliance : Eigen::MatrixXd::Zero(m, m);
            for (Eigen::Index i = 0; i < m; ++i)
              for (Eigen::Index j = 0; j < m; ++j)
                {
                  const double y =
                      length / slices * (static_cast<double>(i / across) - static_cast<double>(j / across));
                  c(i, j) += 4e-6 * std::exp(-std::pow(y / 8, 2)) * std::exp(-std::abs(a - b)) +
                             (a == b ? 2e-6 : 5e-7); // bending and body
                }
          }
      }
    return s;
  }

  Specimen random(const unsigned seed, const int n, const double levers)
  {
    std::mt19937 generator(seed);
    std::normal_distribution<> normal;
    std::uniform_real_distribution<> uniform;
    Eigen::MatrixXd a(n, n);
    for (double &value : a.reshaped())
      value = normal(generator);
    Specimen s{ "random " + std::to_string(seed), {}, std::abs(normal(generator)) + 0.01 };
    s.problem.compliance = a * a.transpose() / n + 0.05 * Eigen::MatrixXd::Identity(n, n);
    s.problem.gap = Eigen::VectorXd::NullaryExpr(n, [&] { return normal(generator); });
    s.problem.lever = Eigen::VectorXd::NullaryExpr(n, [&] {
      const double kind = uniform(generator), size = std::abs(normal(generator)) + 0.05;
      return kind < levers ? size : kind < levers + 0.5 * (1 - levers) ? -size : 0.0;
    });
    s.problem.lever[seed % n] = 1;
    return s;
  }

  Specimen hostile(const unsigned seed)
  {
    std::mt19937 generator(seed);
    std::normal_distribution<> normal;
    std::uniform_real_distribution<> uniform;
    const auto chance = [&](const double probability) { return uniform(generator) < probability; };
    const int n = 2 + static_cast<int>(generator() % 60);
    const double width = std::pow(10, -2 + 2 * uniform(generator)),
                 contrast = chance(0.5) ? 0 : 6 * uniform(generator);
    std::vector<double> x(n), scale(n);
    for (double &value : x)
      value = uniform(generator);
    if (chance(0.3))
      for (int i = 1; i < n; i += 3)
        x[i] = x[i - 1] + (chance(0.5) ? 0 : 1e-9 * uniform(generator));
    for (double &value : scale)
      value = std::pow(10, contrast * (uniform(generator) - 0.5));
    Specimen s{ "hostile " + std::to_string(seed),
                {},
                chance(0.1) ? 0 : std::pow(10, -10 + 20 * uniform(generator)),
                false };
    ContactProblem &p = s.problem;
    p.compliance.resize(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        p.compliance(i, j) = scale[i] * scale[j] * std::exp(-std::pow((x[i] - x[j]) / width, 2));
    if (chance(0.5))
      p.compliance.diagonal() *= 1 + 1e-6;
    p.gap = Eigen::VectorXd::NullaryExpr(n, [&] { return normal(generator) * (chance(0.3) ? 0 : 1); });
    if (chance(0.5))
      p.gap.array() += normal(generator);
    const double coast = chance(0.5) ? 0 : 0.4;
    p.lever = Eigen::VectorXd::NullaryExpr(n, [&] {
      const double kind = uniform(generator);
      return (kind < coast         ? -1
              : kind < 1.1 * coast ? 0
                                   : 1) *
             (chance(0.5) ? 1.0 : std::pow(10, -3 * uniform(generator)));
    });
    p.lever[0] = 1;
    return s;
  }

  /// One list of specimens, a line or two each, in which a reader looks for a kind: it has no parts.
  std::vector<Specimen> all()
  {
    std::vector<Specimen> specimens;
    const auto add = [&](const std::string &name, Specimen s, const bool well_posed = true) {
      s.name = name;
      s.well_posed = well_posed;
      specimens.push_back(std::move(s));
    };
    const auto single = [](ContactProblem p, const double torque) {
      return Specimen{ "", std::move(p), torque };
    };

    add("finite roller", single(patch(15, 15, 10, 0.3, 5, 0), 64.4 * 2000));
    add("roller pressed over every cell", single(patch(9, 9, 10, 0.05, 50, 0), 64.4 * 50000));
    add("three contact lines", contact_lines(3, 15, 11, 200e3));
    add("a billionth of the torque", contact_lines(3, 9, 7, 200e3));
    specimens.back().torque *= 1e-9;
    add("ten thousand times the torque", contact_lines(3, 9, 7, 200e3));
    specimens.back().torque *= 1e4;

    // Flat gaps: every cell touches at once.
    ContactProblem flat = patch(9, 9, 10, 2, 5, 0);
    flat.gap.setConstant(0.01);
    add("flat gaps", single(flat, 64.4 * 1000));
    flat.gap.setZero();
    add("flat gaps, zero", single(flat, 64.4 * 1000));
    add("flat gaps, hardly loaded", single(flat, 64.4e-6));

    // Exact ties by symmetry: mirror images enter together; the identity makes every cell independent.
    ContactProblem independent{ Eigen::MatrixXd::Identity(24, 24), Eigen::VectorXd::Zero(24),
                                Eigen::VectorXd::Ones(24) };
    for (int i = 0; i < 24; ++i)
      independent.gap[i] = i / 4;
    add("exact ties in fours", single(independent, 7));
    add("exact ties, torque at the tie", single(independent, 4));

    // Duplicates: a cell twice, and almost twice. The load between them is anybody's guess, theta is not.
    const auto duplicate = [&](const double difference) {
      ContactProblem p = patch(7, 7, 5, 0.2, 5, 0.001);
      const Eigen::Index n = p.size(), copies = 10;
      ContactProblem d{ Eigen::MatrixXd(n + copies, n + copies), Eigen::VectorXd(n + copies),
                        Eigen::VectorXd::Constant(n + copies, 64.4) };
      const auto source = [&](const Eigen::Index i) { return i < n ? i : 19 + (i - n); };
      for (Eigen::Index i = 0; i < n + copies; ++i)
        {
          d.gap[i] = p.gap[source(i)];
          for (Eigen::Index j = 0; j < n + copies; ++j)
            d.compliance(i, j) =
                p.compliance(source(i), source(j)) * (1 + (i == j && i >= n ? difference : 0));
        }
      return single(d, 64.4 * 800);
    };
    add("duplicated cells", duplicate(0), false);
    add("nearly duplicated cells", duplicate(1e-13), false);
    add("cells duplicated to 1e-9", duplicate(1e-9), false);

    // Contrast: every other cell a million times softer.
    Specimen contrast = contact_lines(2, 9, 7, 50e3);
    for (Eigen::Index i = 0; i < contrast.problem.size(); i += 2)
      contrast.problem.compliance(i, i) *= 1e6;
    add("contrast of a million", contrast);

    for (const double unit : { 1e-30, 1e30 })
      {
        Specimen s = contact_lines(2, 7, 7, 100e3);
        s.problem.compliance *= unit;
        s.problem.gap *= unit;
        add(unit < 1 ? "units of 1e-30" : "units of 1e30", s);
      }

    // Near-singular: a Gaussian kernel has no smallest eigenvalue worth the name.
    ContactProblem smooth = patch(8, 8, 5, 0.5, 5, 0.001);
    for (Eigen::Index i = 0; i < 64; ++i)
      for (Eigen::Index j = 0; j < 64; ++j)
        smooth.compliance(i, j) =
            1e-5 * std::exp(-0.05 * (std::pow(i % 8 - j % 8, 2) + std::pow(i / 8 - j / 8, 2)));
    add("near-singular kernel", single(smooth, 64.4 * 100), false);

    // Edge-loaded misalignment: everything on one corner.
    ContactProblem corner = patch(15, 11, 20, 0.4, 10, 0);
    for (Eigen::Index i = 0; i < corner.size(); ++i)
      corner.gap[i] += 0.05 * static_cast<double>(i / 11);
    add("edge-loaded misalignment", single(corner, 64.4 * 500));

    add("single cell", single({ Eigen::MatrixXd::Constant(1, 1, 2e-6), Eigen::VectorXd::Constant(1, -0.3),
                                Eigen::VectorXd::Constant(1, 64.4) },
                              1e5));

    // Unsymmetric as the split compliance is: up to three per cent.
    Specimen unsymmetric = contact_lines(2, 9, 7, 100e3);
    for (Eigen::Index i = 0; i < unsymmetric.problem.size(); ++i)
      for (Eigen::Index j = 0; j < i; ++j)
        unsymmetric.problem.compliance(i, j) *= 1 + 0.03 * std::sin(7.0 * i + 3.0 * j);
    unsymmetric.problem.symmetric = false;
    add("unsymmetric", unsymmetric);

    // Preload on both flanks, as the double-roller drive has it: drive cells, coast cells, some without
    // lever.
    Specimen preload = contact_lines(2, 7, 7, 20e3);
    for (Eigen::Index i = 0; i < preload.problem.size(); ++i)
      {
        preload.problem.gap[i] -= 0.003;
        preload.problem.lever[i] *= i < 49 ? 1 : -0.8;
        if (i % 17 == 0)
          preload.problem.lever[i] = 0;
      }
    add("preload on both flanks", preload);
    preload.torque = 0;
    add("preload on both flanks, no torque", preload);
    preload.torque = -20e3;
    add("preload on both flanks, other flank driven", preload);
    preload.problem.gap.array() += 0.02;
    add("backlash, other flank driven", preload);
    preload.torque = 0;
    add("backlash, no torque", preload);
    return specimens;
  }
} // namespace flank::zoo
