// SPDX-License-Identifier: GPL-2.0-or-later
// The elements alone, against closed forms.
#include "mesh/base/gauss.hpp"
#include "mesh/base/units.hpp"
#include "solver/elements/body_elements.hpp"
#include "solver/elements/flank_surface.hpp"
#include "solver/linear/direct_solver.hpp"
#include "tests/example_pairs.hpp"

#include <gtest/gtest.h>

#include <numeric>

using namespace flank;

namespace
{
  /// Trilinear map through a mesh's own vertices (straight edges).
  Eigen::Vector3d trilinear(const HexMesh &mesh, const int cell, const Eigen::Vector3d &reference)
  {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    for (int i = 0; i < 8; ++i)
      {
        double weight = 1;
        for (int d = 0; d < 3; ++d)
          weight *= (i >> d & 1) ? reference[d] : 1 - reference[d];
        point += weight * mesh.vertices[mesh.cells[cell][i]];
      }
    return point;
  }

  constexpr double E = 2e5, nu = 0.3;

  /// n^3 cells on the unit cube, moved by `warp` (identity: straight).
  HexMesh cube(const int n, const std::function<Eigen::Vector3d(const Eigen::Vector3d &)> &warp,
               const bool curved)
  {
    HexMesh mesh;
    const auto id = [n](int i, int j, int k) { return (k * (n + 1) + j) * (n + 1) + i; };
    for (int k = 0; k <= n; ++k)
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
          mesh.vertices.push_back(warp(Eigen::Vector3d(i, j, k) / n));
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
          mesh.cells.push_back({ id(i, j, k), id(i + 1, j, k), id(i, j + 1, k), id(i + 1, j + 1, k),
                                 id(i, j, k + 1), id(i + 1, j, k + 1), id(i, j + 1, k + 1),
                                 id(i + 1, j + 1, k + 1) });
    if (curved)
      mesh.map = [n, warp](const int cell, const Eigen::Vector3d &x) {
        return warp((Eigen::Vector3d(cell % n, cell / n % n, cell / n / n) + x) / n);
      };
    else
      mesh.map = [copy = std::make_shared<HexMesh>(mesh)](const int cell, const Eigen::Vector3d &x) {
        return trilinear(*copy, cell, x);
      };
    return mesh;
  }

  /// Root mean square of displacement - exact over the cells' reference volumes, by Gauss' rule. [mm]
  double error_of(const ElasticBody &body, const int cells, const Eigen::VectorXd &displacement,
                  const std::function<Eigen::Vector3d(const Eigen::Vector3d &)> &exact)
  {
    const GaussRule &rule = gauss(body.degree() + 2);
    std::vector<Eigen::Vector3d> points;
    std::vector<double> weights;
    for (std::size_t i = 0; i < rule.point.size(); ++i)
      for (std::size_t j = 0; j < rule.point.size(); ++j)
        for (std::size_t k = 0; k < rule.point.size(); ++k)
          {
            points.emplace_back(rule.point[i], rule.point[j], rule.point[k]);
            weights.push_back(rule.weight[i] * rule.weight[j] * rule.weight[k]);
          }
    std::vector<int> all(cells);
    std::iota(all.begin(), all.end(), 0);
    double sum = 0;
    body.each_sample(all, points, displacement, [&](int, const ElasticBody::Samples &s) {
      for (std::size_t q = 0; q < points.size(); ++q)
        sum += weights[q] * (s.displacement.col(q) - exact(s.position.col(q))).squaredNorm();
    });
    return std::sqrt(sum / cells);
  }

  std::vector<char> where(const ElasticBody &body,
                          const std::function<bool(const Eigen::Vector3d &)> &condition)
  {
    std::vector<char> fixed(body.n_unknowns(), 0);
    for (int v = 0; v < body.n_nodes(); ++v)
      if (condition(body.node_positions()[v]))
        for (int c = 0; c < 3; ++c)
          fixed[3 * v + c] = 1;
    return fixed;
  }

  Eigen::VectorXd nodal(const ElasticBody &body,
                        const std::function<Eigen::Vector3d(const Eigen::Vector3d &)> &f)
  {
    Eigen::VectorXd values(body.n_unknowns());
    for (int v = 0; v < body.n_nodes(); ++v)
      values.segment<3>(3 * v) = f(body.node_positions()[v]);
    return values;
  }

  bool on_cube_surface(const Eigen::Vector3d &x)
  {
    return (x.array() < 1e-9).any() || (x.array() > 1 - 1e-9).any();
  }
} // namespace

TEST(Elasticity, PatchTestOnDistortedCells)
{
  const auto warp = [](const Eigen::Vector3d &x) -> Eigen::Vector3d {
    const double bubble = x.x() * (1 - x.x()) * x.y() * (1 - x.y()) * x.z() * (1 - x.z());
    return x + 4 * bubble * Eigen::Vector3d(1, -0.7, 0.5);
  };
  const auto linear = [](const Eigen::Vector3d &x) {
    return Eigen::Vector3d(1e-3 * x.x() + 2e-3 * x.y(), -1e-3 * x.z(), 5e-4 * x.x() + 1e-3 * x.z());
  };
  for (const int degree : { 1, 2, 3 })
    {
      const auto body_owner = make_elastic_body(cube(3, warp, false), degree, E, nu);
      const ElasticBody &body = *body_owner;
      const auto solver = make_direct_solver(body.stiffness(), where(body, on_cube_surface));
      const auto u = solver->solve(Eigen::VectorXd::Zero(body.n_unknowns()), nodal(body, linear));
      EXPECT_LT((u - nodal(body, linear)).cwiseAbs().maxCoeff(), 1e-14); // rounding of displacements of 1e-3
    }
}

// Papkovich and Neuber's general solution without body forces, with one harmonic function h along z:
// u = (3 - 4 nu) h e_z - z grad h (Gurtin 1972).
TEST(Elasticity, ClosedFormWithoutBodyForceConvergesAtOrderDegreePlusOne)
{
  // No steel: shear and bulk stiffness are told apart; part or all of lambda acts on projected dilatations.
  for (const double nu : { 0.42, 0.4999 })
    {
      const double a = 1.5, b = 1.2, c = std::hypot(a, b);
      const auto exact = [=](const Eigen::Vector3d &x) -> Eigen::Vector3d {
        const double grow = 1e-3 * std::exp(c * x.z()), sx = std::sin(a * x.x()), cx = std::cos(a * x.x()),
                     sy = std::sin(b * x.y()), cy = std::cos(b * x.y());
        const Eigen::Vector3d gradient(a * cx * cy * grow, -b * sx * sy * grow, c * sx * cy * grow);
        return (3 - 4 * nu) * sx * cy * grow * Eigen::Vector3d::UnitZ() - x.z() * gradient;
      };
      const auto warp = [](const Eigen::Vector3d &x) -> Eigen::Vector3d {
        const double bubble = x.x() * (1 - x.x()) * x.y() * (1 - x.y()) * x.z() * (1 - x.z());
        return x + 2 * bubble * Eigen::Vector3d(1, -0.7, 0.5);
      };
      for (const int degree : { 1, 2, 3 })
        {
          std::vector<double> errors;
          for (const int n : degree == 1 ? std::vector{ 4, 8 } : std::vector{ 2, 4 })
            {
              const auto body_owner = make_elastic_body(cube(n, warp, true), degree, E, nu);
              const ElasticBody &body = *body_owner;
              const auto solver = make_direct_solver(body.stiffness(), where(body, on_cube_surface));
              const Eigen::VectorXd unloaded = Eigen::VectorXd::Zero(body.n_unknowns());
              errors.push_back(error_of(body, n * n * n, solver->solve(unloaded, nodal(body, exact)), exact));
            }
          const double order = std::log2(errors[0] / errors[1]);
          EXPECT_GT(order, degree + 0.7)
              << degree << " " << nu; // degree + 1 in the limit; two coarse meshes of curved cells
          EXPECT_LT(order, degree + 1.8) << degree << " " << nu;
        }
    }
}

// Lame, plane strain. The ring's mesh, its supports and loads stand here because nothing else has them.
TEST(Elasticity, ThickRingUnderInnerPressure)
{
  const double inner = 1, outer = 2, height = 0.5, pressure = 100;
  const int nr = 4, nt = 6;
  HexMesh mesh;
  const auto point = [&](double r, double t, double z) {
    return Eigen::Vector3d((inner + (outer - inner) * r) * std::cos(t * units::pi / 2),
                           (inner + (outer - inner) * r) * std::sin(t * units::pi / 2), height * z);
  };
  const auto id = [&](int i, int j, int k) { return (k * (nt + 1) + j) * (nr + 1) + i; };
  for (int k = 0; k <= 1; ++k)
    for (int j = 0; j <= nt; ++j)
      for (int i = 0; i <= nr; ++i)
        mesh.vertices.push_back(point(1.0 * i / nr, 1.0 * j / nt, k));
  for (int j = 0; j < nt; ++j)
    for (int i = 0; i < nr; ++i)
      mesh.cells.push_back({ id(i, j, 0), id(i + 1, j, 0), id(i, j + 1, 0), id(i + 1, j + 1, 0), id(i, j, 1),
                             id(i + 1, j, 1), id(i, j + 1, 1), id(i + 1, j + 1, 1) });
  mesh.map = [=](const int cell, const Eigen::Vector3d &x) {
    return point((cell % nr + x[0]) / nr, (cell / nr + x[1]) / nt, x[2]);
  };
  // Cubic, quadratic and linear elements, four across the wall. At Poisson's ratio 0.4999 quadratic ones that
  // must keep their volume at every quadrature point are 9 % off, their stresses 60 times the pressure.
  for (const double nu : { 0.3, 0.45, 0.4999 })
    for (const auto &[degree, displacement, stress] :
         { std::tuple(3, 5e-6, 0.005), std::tuple(2, 2e-4, 0.05), std::tuple(1, 0.03, 0.5) })
      {
        const auto body_owner = make_elastic_body(mesh, degree, E, nu);
        const ElasticBody &body = *body_owner;
        std::vector<char> fixed(body.n_unknowns(), 0);
        for (int v = 0; v < body.n_nodes(); ++v)
          {
            const Eigen::Vector3d &x = body.node_positions()[v];
            fixed[3 * v] = std::abs(x.x()) < 1e-9;
            fixed[3 * v + 1] = std::abs(x.y()) < 1e-9;
            fixed[3 * v + 2] = 1; // plane strain
          }
        Eigen::VectorXd load = Eigen::VectorXd::Zero(body.n_unknowns());
        for (int j = 0; j < nt; ++j)
          body.add_traction(
              j * nr, 0,
              [&](const Eigen::Vector3d &, const Eigen::Vector3d &normal) -> Eigen::Vector3d {
                return -pressure * normal;
              },
              load);
        const auto u = make_direct_solver(body.stiffness(), fixed)->solve(load);
        const double c = pressure * inner * inner / (outer * outer - inner * inner);
        const auto exact = [&](const double r) {
          return (1 + nu) / E * c * ((1 - 2 * nu) * r + outer * outer / r);
        };
        double worst = 0;
        for (int v = 0; v < body.n_nodes(); ++v)
          {
            const Eigen::Vector3d &x = body.node_positions()[v];
            const double r = x.norm() > 0 ? x.head<2>().norm() : 1;
            worst = std::max(worst, std::abs(u.segment<2>(3 * v).dot(x.head<2>()) / r / exact(r) - 1));
          }
        double worst_stress =
            0; // of the sum of radial and tangential stress, 2 c everywhere; over the pressure
        std::vector<int> all(mesh.cells.size());
        std::iota(all.begin(), all.end(), 0);
        body.each_sample(
            all, { { 0.5, 0.5, 0.5 }, { 0.2, 0.7, 0.3 } }, u, [&](int, const ElasticBody::Samples &s) {
              for (Eigen::Index q = 0; q < s.stress.cols(); ++q)
                worst_stress =
                    std::max(worst_stress, std::abs(s.stress(0, q) + s.stress(1, q) - 2 * c) / pressure);
            });
        EXPECT_LT(worst, displacement) << nu << " " << degree;
        EXPECT_LT(worst_stress, stress) << nu << " " << degree;
      }
}

// The twist under a torque grows with 1/r^2 to the bore: layers there are in proportion to their radius.

namespace
{
  /// Area of a tooth's section from its elements' outlines. [mm^2]
  double area(const ToothSection &section)
  {
    constexpr int n = 40; // points an edge
    double sum = 0;
    for (int quad = 0; quad < static_cast<int>(section.quads().size()); ++quad)
      {
        std::vector<Eigen::Vector2d> outline;
        for (int i = 0; i < 4 * n; ++i)
          {
            const double t = i % n / static_cast<double>(n);
            const std::array<Eigen::Vector2d, 4> at = { { { t, 0 }, { 1, t }, { 1 - t, 1 }, { 0, 1 - t } } };
            outline.push_back(section.map(quad, at[i / n].x(), at[i / n].y()));
          }
        for (std::size_t i = 0; i < outline.size(); ++i)
          {
            const Eigen::Vector2d &a = outline[i], &b = outline[(i + 1) % outline.size()];
            sum += 0.5 * (a.x() * b.y() - a.y() * b.x());
          }
      }
    return std::abs(sum);
  }

  double triangle(const Eigen::Vector2d &a, const Eigen::Vector2d &b, const Eigen::Vector2d &c)
  {
    return 0.5 * std::abs((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
  }

  Eigen::Vector2d on_flank(const Gear &gear, const double radius)
  {
    const double roll = std::sqrt(std::pow(radius / gear.base_radius, 2) - 1),
                 angle = gear.half_angle_at_base - roll + std::atan(roll);
    return { radius * std::cos(angle), radius * std::sin(angle) };
  }
} // namespace

// What a chamfer takes off a tooth's section is two triangles at 45 degrees, but for the curvature of flank
// and tip circle, whatever the number of elements.
TEST(ToothSection, ChamfersTakeTheirCornersOff)
{
  PairData data = paper_pair(0);
  const Gear sharp = make_gear_pair(data).pinion;
  for (const int columns : { 2, 4, 6, 8 })
    {
      SectorResolution size;
      size.tooth_columns = columns;
      const double whole = area(ToothSection(sharp, size));
      for (const double chamfer : { 0.2, 0.5 })
        {
          data.pinion.tip_chamfer = chamfer;
          const Eigen::Vector2d end = on_flank(sharp, sharp.tip_radius - chamfer), up = end.normalized(),
                                land = end + chamfer * (up - Eigen::Vector2d(-up.y(), up.x()));
          const double taken = 2 * triangle(end, on_flank(sharp, sharp.tip_radius), land);
          EXPECT_NEAR(whole - area(ToothSection(make_gear_pair(data).pinion, size)), taken, 0.02 * taken)
              << columns << " columns, chamfer " << chamfer;
        }
    }
}

// Chamfers that are small, that leave a third of the land, that take much of the flank; of teeth with a
// radial line below the base circle and of such without.
TEST(ToothSection, ChamferedTeethCanBeMeshed)
{
  for (const int teeth : { 12, 50, 300 })
    for (const double chamfer : { 0.08, 0.5, 1.5 })
      for (const int columns : { 2, 4, 8 })
        {
          PairData data = paper_pair(20);
          data.pinion.teeth = teeth;
          data.pinion.tooth_thickness = std::nan(""), data.pinion.profile_shift = teeth == 12 ? 0.3 : 0;
          const double reference = 1.5 * teeth;
          data.centre_distance = reference + 75 + 0.9 + 0.1;
          data.pinion.root_radius = reference - 3.2, data.pinion.tip_radius = reference + 3;
          data.pinion.bore_radius = 0.5 * data.pinion.root_radius;
          data.pinion.fillet_radius = 0.7, data.pinion.tip_chamfer = chamfer;
          data.gear.tip_radius = 77;
          SectorResolution size;
          size.flank_rows = 6, size.tooth_columns = columns, size.face_layers = 2;
          for (const int degree : { 1, 2, 3 })
            {
              if (degree != 2 && columns != 4)
                continue;
              size.degree = degree;
              const BodyElements elements(make_gear_pair(data).pinion, size);
              EXPECT_GT(elements.body().least_scaled_jacobian(), 0)
                  << teeth << " teeth, chamfer " << chamfer << ", columns " << columns << ", degree "
                  << degree;
              const FlankSurface surface = flank_surface(elements.sector());
              const auto nodes = flank_nodes(elements.sector(), surface, elements.body());
              const Eigen::Vector3d tip = elements.body().node_positions()[nodes[surface.node(0, 0)]];
              EXPECT_NEAR(tip.head<2>().norm(), data.pinion.tip_radius - chamfer, 1e-9);
            }
        }
}
