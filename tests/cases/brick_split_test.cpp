// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/half_space/half_space.hpp"
#include "solver/elements/lagrange.hpp"
#include "solver/linear/direct_solver.hpp"

#include <gtest/gtest.h>

#include <memory>

using namespace flank;

namespace
{
  constexpr double E = 206e3, nu = 0.3, a = 0.15, b = 0.25; // patch half-lengths, centred on the loaded face z = 0, inward +z
  using Line = std::vector<double>;

  HexMesh brick(const Line &x, const Line &y, const Line &z)
  {
    HexMesh    mesh;
    const int  nx = static_cast<int>(x.size()), ny = static_cast<int>(y.size()), nz = static_cast<int>(z.size());
    const auto id = [=](int i, int j, int k) { return (k * ny + j) * nx + i; };
    for (const double zk : z)
      for (const double yj : y)
        for (const double xi : x)
          mesh.vertices.emplace_back(xi, yj, zk);
    for (int k = 0; k + 1 < nz; ++k)
      for (int j = 0; j + 1 < ny; ++j)
        for (int i = 0; i + 1 < nx; ++i)
          mesh.cells.push_back({ id(i, j, k), id(i + 1, j, k), id(i, j + 1, k), id(i + 1, j + 1, k), id(i, j, k + 1), id(i + 1, j, k + 1),
                                 id(i, j + 1, k + 1), id(i + 1, j + 1, k + 1) });
    mesh.map = [copy = std::make_shared<HexMesh>(mesh)](const int cell, const Eigen::Vector3d &p) { return trilinear(*copy, cell, p); };
    return mesh;
  }

  /// Consistent load of the unit-force patch: its overlap with each cell by three Gauss points a direction, exact for
  /// quadratic and cubic shape functions.
  Eigen::VectorXd patch_load(const ElasticBody &body, const Line &x, const Line &y)
  {
    Eigen::VectorXd           load = Eigen::VectorXd::Zero(body.n_unknowns());
    const auto               &s    = body.abscissas();
    const LagrangePolynomials polynomials(s);
    const int                 n = polynomials.size();
    for (std::size_t j = 0; j + 1 < y.size(); ++j)
      for (std::size_t i = 0; i + 1 < x.size(); ++i)
        {
          const double x0 = std::max(x[i], -a), x1 = std::min(x[i + 1], a), y0 = std::max(y[j], -b), y1 = std::min(y[j + 1], b);
          if (x1 <= x0 || y1 <= y0)
            continue;
          const auto &nodes = body.cell_nodes(static_cast<int>(j * (x.size() - 1) + i));
          for (const auto &[gx, wx] : { std::pair{ 0.1127016653792583, 5.0 / 18 }, { 0.5, 8.0 / 18 }, { 0.8872983346207417, 5.0 / 18 } })
            for (const auto &[gy, wy] : { std::pair{ 0.1127016653792583, 5.0 / 18 }, { 0.5, 8.0 / 18 }, { 0.8872983346207417, 5.0 / 18 } })
              {
                const auto u = polynomials.values((x0 + gx * (x1 - x0) - x[i]) / (x[i + 1] - x[i]));
                const auto v = polynomials.values((y0 + gy * (y1 - y0) - y[j]) / (y[j + 1] - y[j]));
                for (int q = 0; q < n; ++q)
                  for (int p = 0; p < n; ++p)
                    load[3 * nodes[q * n + p] + 2] += wx * wy * (x1 - x0) * (y1 - y0) / (4 * a * b) * u[p] * v[q];
              }
        }
    return load;
  }

  Line equal(const double from, const double to, const int n)
  {
    Line line;
    for (int i = 0; i <= n; ++i)
      line.push_back(from + (to - from) * i / n);
    return line;
  }

  std::vector<char> flags(const ElasticBody &body, const std::function<std::array<bool, 3>(const Eigen::Vector3d &)> &fixed)
  {
    std::vector<char> result(body.n_unknowns(), 0);
    for (int v = 0; v < body.n_nodes(); ++v)
      for (int c = 0; c < 3; ++c)
        result[3 * v + c] = fixed(body.node_positions()[v])[c];
    return result;
  }
} // namespace

TEST(ProjectedSplit, OwnComplianceOnABrickAgainstAFineSolve)
{
  // Reference: a quarter of the 12 x 12 x 6 brick (clamped sides and bottom), cubic elements graded to the patch, no half-space in it.
  double reference;
  {
    const Line x = { 0, 0.08, 0.125, 0.15, 0.175, 0.25, 0.45, 0.9, 1.8, 3.5, 6 },
               y = { 0, 0.13, 0.21, 0.25, 0.29, 0.4, 0.7, 1.3, 2.4, 4, 6 }, z = { 0, 0.05, 0.12, 0.25, 0.5, 1, 2, 3.6, 6 };
    const auto         body_owner = make_elastic_body(brick(x, y, z), 3, E, nu);
    const ElasticBody &body       = *body_owner;
    const auto         load       = patch_load(body, x, y); // a quarter of the unit force
    const auto         fixed      = flags(body, [](const Eigen::Vector3d &p) {
      const bool clamped = p.x() > 6 - 1e-9 || p.y() > 6 - 1e-9 || p.z() > 6 - 1e-9;
      return std::array<bool, 3>{ clamped || p.x() < 1e-9, clamped || p.y() < 1e-9, clamped };
    });
    reference                     = load.dot(make_direct_solver(body.stiffness(), fixed)->solve(load)) / 0.25;
  }

  // The split on quadratic elements of 1.2 mm, four times as long as the patch is wide.
  const Line         x = equal(-6, 6, 10), z = equal(0, 6, 5);
  const auto         body_owner = make_elastic_body(brick(x, x, z), 2, E, nu);
  const ElasticBody &body       = *body_owner;
  const auto         load       = patch_load(body, x, x);
  const auto         fixed      = flags(body, [](const Eigen::Vector3d &p) {
    const bool clamped = std::abs(p.x()) > 6 - 1e-9 || std::abs(p.y()) > 6 - 1e-9 || p.z() > 6 - 1e-9;
    return std::array<bool, 3>{ clamped, clamped, clamped };
  });
  const double       plain      = load.dot(make_direct_solver(body.stiffness(), fixed)->solve(load));

  // Block: the four loaded elements and two rings, three layers; cut on its sides and bottom.
  const Line         bx(x.begin() + 2, x.end() - 2), bz(z.begin(), z.begin() + 4);
  const auto         block_owner = make_elastic_body(brick(bx, bx, bz), 2, E, nu);
  const ElasticBody &block       = *block_owner;
  const double       side = bx.back(), bottom = bz.back();
  const auto         cut = [=](const Eigen::Vector3d &p) {
    return std::abs(p.x()) > side - 1e-9 || std::abs(p.y()) > side - 1e-9 || p.z() > bottom - 1e-9;
  };
  Eigen::VectorXd prescribed = Eigen::VectorXd::Zero(block.n_unknowns());
  for (int v = 0; v < block.n_nodes(); ++v)
    if (cut(block.node_positions()[v]))
      prescribed.segment<3>(3 * v) = half_space::love_displacement(a, b, block.node_positions()[v], E, nu);
  const auto   block_load     = patch_load(block, bx, bx);
  const double elements       = block_load.dot(make_direct_solver(block.stiffness(), flags(block,
                                                                                           [&](const Eigen::Vector3d &p) {
                                                                                       const bool c = cut(p);
                                                                                       return std::array<bool, 3>{ c, c, c };
                                                                                     }))
                                                   ->solve(block_load, prescribed));
  const double half_space_own = half_space::surface_compliance(E, nu) * half_space::mean_love_potential({ 0, 0, a, b }, { 0, 0, a, b });
  const double split          = plain + half_space_own - elements;
  EXPECT_NEAR(split, reference, 2e-3 * reference); // 0.2 % inside the flank
  EXPECT_LT(plain, 0.9 * reference);               // what the elements alone miss
  RecordProperty("relative_error", std::to_string(split / reference - 1));
  std::cout << "split / fine solve - 1 = " << split / reference - 1 << ", plain " << plain / reference - 1 << "\n";
}
