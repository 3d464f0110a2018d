// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/half_space/half_space.hpp"

#include "mesh/base/units.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flank::half_space
{
  namespace
  {
    using units::pi;

    /// x asinh(y/|x|) + y asinh(x/|y|), zero where a divisor is zero.
    double corner(const double x, const double y)
    {
      return (x == 0 ? 0 : x * std::asinh(y / std::abs(x))) + (y == 0 ? 0 : y * std::asinh(x / std::abs(y)));
    }

    /// One value for each pair of corners of two rectangles.
    using Corners = Eigen::Array<double, 16, 1>;

    /// Fourth mixed primitive of 1/r, twice in x and twice in y; even in both. Without -(|x|^3 + |y|^3)/6 of
    /// it, which no rectangles see: of slender ones that is all but the last digits. s: the shorter, l: the
    /// longer of |x| and |y|, r - l = s^2/(r + l); asinh(l/s) = log((l + r)/s), finite at 0 for the product.
    Corners double_corner(const Corners &x, const Corners &y)
    {
      const Corners u = x.abs().max(1e-30), v = y.abs().max(1e-30), s = u.min(v), l = u.max(v),
                    r = (u * u + v * v).sqrt(), s2 = s * s;
      return 0.5 * s * l * (s * ((l + r) / s).log() + l * ((s + s2 / (r + l)) / l).log1p()) -
             s2 * ((r * r + r * l + l * l) / (r + l) - s) / 6;
    }

    constexpr std::array<double, 3> gauss_point = { -0.7745966692414834, 0, 0.7745966692414834 };
    constexpr std::array<double, 3> gauss_weight = { 5.0 / 18, 8.0 / 18, 5.0 / 18 };
  } // namespace

  double love_potential(const Rectangle &s, const double x, const double y)
  {
    const double dx = x - s.x, dy = y - s.y;
    return (corner(dx + s.a, dy + s.b) - corner(dx - s.a, dy + s.b) - corner(dx + s.a, dy - s.b) +
            corner(dx - s.a, dy - s.b)) /
           s.area();
  }

  namespace
  {
    /// How a mean potential is found, nearest first.
    enum class MeanPotential
    {
      corners,     ///< closed form
      nine_points, ///< two uniform densities convolved along y, three Gauss points on each; across, where the
                   ///< rectangles are short, the second moment alone
      three_points, ///< with the convolution's second and fourth moments: from eight half-lengths on as good
                    ///< (1e-6)
      expansion     ///< 1/r and the second moments of both rectangles; the next term is of order (size/r)^4
    };

    MeanPotential way_of(const RectanglePair &p)
    {
      const double a = std::max(p.a1, p.a2), b = std::max(p.b1, p.b2), size = std::max(a, b),
                   r2 = p.dx * p.dx + p.dy * p.dy;
      // Rectangles of a grid are 2, 4, 6, ... half-lengths apart: no bound is at a square of those, where
      // rounding would choose the way.
      if (r2 <= 18 * size * size)
        return MeanPotential::corners;
      if (r2 > 264 * size * size)
        return MeanPotential::expansion;
      if (a > 0.51 * b)
        return MeanPotential::corners;
      return r2 > 68 * size * size ? MeanPotential::three_points : MeanPotential::nine_points;
    }

    /// Some pairs side by side, as a processor's vectors take them.
    constexpr int pack_size = 4;
    using Pack = Eigen::Array<double, pack_size, 1>;

    struct PackOfPairs
    {
      Pack dx, dy, a1, b1, a2, b2;

      void set(const int k, const RectanglePair &p)
      {
        dx[k] = p.dx, dy[k] = p.dy, a1[k] = p.a1, b1[k] = p.b1, a2[k] = p.a2, b2[k] = p.b2;
      }

      /// A point of the densities convolved along y, with the second moment across.
      Pack at(const Pack &y) const
      {
        const Pack xx = (a1 * a1 + a2 * a2) / 6, x2 = dx * dx, y2 = y * y, inverse2 = 1 / (x2 + y2),
                   inverse = inverse2.sqrt();
        return inverse * (1 + xx * (2 * x2 - y2) * (inverse2 * inverse2));
      }

      Pack mean(const MeanPotential way) const
      {
        if (way == MeanPotential::expansion)
          {
            const Pack x2 = dx * dx, y2 = dy * dy, r2 = x2 + y2, xx = (a1 * a1 + a2 * a2) / 6,
                       yy = (b1 * b1 + b2 * b2) / 6;
            return (1 + (xx * (2 * x2 - y2) + yy * (2 * y2 - x2)) / (r2 * r2)) / r2.sqrt();
          }
        if (way == MeanPotential::three_points)
          {
            const Pack bb = b1 * b1, cc = b2 * b2, second = (bb + cc) / 3,
                       fourth = (bb * bb + cc * cc) / 5 + 2.0 / 3 * bb * cc, aside = (fourth / second).sqrt(),
                       weight = 0.5 * second * second / fourth;
            return weight * (at(dy - aside) + at(dy + aside)) + (1 - 2 * weight) * at(dy);
          }
        Pack sum = Pack::Zero();
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            sum += gauss_weight[i] * gauss_weight[j] * at(dy + gauss_point[i] * b2 - gauss_point[j] * b1);
        return sum;
      }
    };

    double mean_by_corners(const RectanglePair &p)
    {
      Corners x, y, sign;
      int c = 0;
      for (const int i : { -1, 1 })
        for (const int j : { -1, 1 })
          for (const int k : { -1, 1 })
            for (const int l : { -1, 1 })
              {
                x[c] = p.dx + i * p.a1 + j * p.a2;
                y[c] = p.dy + k * p.b1 + l * p.b2;
                sign[c++] = i * j * k * l;
              }
      return (sign * double_corner(x, y)).sum() / (16 * p.a1 * p.b1 * p.a2 * p.b2);
    }
  } // namespace

  void mean_love_potentials(const std::span<const RectanglePair> pairs, const std::span<double> mean)
  {
    struct Waiting
    {
      PackOfPairs pack;
      std::array<std::size_t, pack_size> pair;
      int count = 0;
    };
    std::array<Waiting, 4> of_way;
    const auto work_off = [&](const MeanPotential way, Waiting &waiting) {
      for (int k = waiting.count; k < pack_size; ++k) // filled up with the last
        waiting.pack.set(k, pairs[waiting.pair[waiting.count - 1]]);
      const Pack found = waiting.pack.mean(way);
      for (int k = 0; k < waiting.count; ++k)
        mean[waiting.pair[k]] = found[k];
      waiting.count = 0;
    };
    for (std::size_t k = 0; k < pairs.size(); ++k)
      if (const MeanPotential way = way_of(pairs[k]); way == MeanPotential::corners)
        mean[k] = mean_by_corners(pairs[k]);
      else
        {
          Waiting &waiting = of_way[static_cast<int>(way)];
          waiting.pack.set(waiting.count, pairs[k]);
          waiting.pair[waiting.count++] = k;
          if (waiting.count == pack_size)
            work_off(way, waiting);
        }
    for (const MeanPotential way :
         { MeanPotential::nine_points, MeanPotential::three_points, MeanPotential::expansion })
      if (Waiting &waiting = of_way[static_cast<int>(way)]; waiting.count > 0)
        work_off(way, waiting);
  }

  double mean_love_potential(const Rectangle &s, const Rectangle &t)
  {
    const RectanglePair pair{ t.x - s.x, t.y - s.y, s.a, s.b, t.a, t.b };
    const MeanPotential way = way_of(pair);
    if (way == MeanPotential::corners)
      return mean_by_corners(pair);
    PackOfPairs pack;
    for (int k = 0; k < pack_size; ++k)
      pack.set(k, pair);
    return pack.mean(way)[0];
  }

  namespace
  {
    double safe_atan(const double numerator, const double denominator)
    {
      return denominator == 0 ? (numerator == 0 ? 0 : std::copysign(pi / 2, numerator))
                              : std::atan(numerator / denominator);
    }

    /// t + rho without cancellation for t < 0; rho^2 = t^2 + rest2.
    double sum_with(const double t, const double rho, const double rest2)
    {
      return t >= 0 ? t + rho : rest2 / (rho - t);
    }

    /// Calls use(sign, s, t, rho) for the four corners of the rectangle seen from p.
    template <class Use>
    void corners(const double a, const double b, const Eigen::Vector3d &p, const Use &use)
    {
      for (const int i : { -1, 1 })
        for (const int j : { -1, 1 })
          {
            const double s = p.x() + i * a, t = p.y() + j * b;
            use(static_cast<double>(i * j), s, t, std::sqrt(s * s + t * t + p.z() * p.z()));
          }
    }
  } // namespace

  Eigen::Vector3d love_displacement(const double a, const double b, const Eigen::Vector3d &p,
                                    const double youngs_modulus, const double nu)
  {
    const double z = p.z();
    double v = 0, vx = 0, vy = 0, vz = 0, chix = 0, chiy = 0;
    corners(a, b, p, [&](const double sign, const double s, const double t, const double rho) {
      const double lt = std::log(sum_with(t, rho, s * s + z * z)),
                   ls = std::log(sum_with(s, rho, t * t + z * z)), lz = std::log(z + rho);
      const double at = safe_atan(s * t, z * rho), xt = safe_atan(t * z, s * rho) - safe_atan(t, s),
                   yt = safe_atan(s * z, t * rho) - safe_atan(s, t);
      v += sign * (s * lt + t * ls - z * at);
      vx += sign * lt;
      vy += sign * ls;
      vz -= sign * at;
      chix += sign * (t * lz + z * lt - s * xt);
      chiy += sign * (s * lz + z * ls - t * yt);
    });
    const double scale = (1 + nu) / (2 * pi * youngs_modulus) / (4 * a * b), k = 1 - 2 * nu;
    return scale * Eigen::Vector3d(-k * chix - z * vx, -k * chiy - z * vy, 2 * (1 - nu) * v - z * vz);
  }

  Eigen::Matrix3d love_stress(const double a, const double b, const Eigen::Vector3d &p, const double nu)
  {
    // On the surface in line with a side of the rectangle single terms are infinite, their sum is not: a hair
    // below it.
    const double z = std::max(p.z(), 1e-9 * std::min(a, b)), k = 1 - 2 * nu, scale = 1 / (2 * pi * 4 * a * b);
    double vz = 0, chixx = 0, chiyy = 0, chixy = 0, vxx = 0, vyy = 0, vxy = 0, vxz = 0, vyz = 0;
    corners(a, b, { p.x(), p.y(), z },
            [&](const double sign, const double s, const double t, const double rho) {
              const double inverse_t = 1 / (rho * sum_with(t, rho, s * s + z * z)),
                           inverse_s = 1 / (rho * sum_with(s, rho, t * t + z * z));
              vz -= sign * safe_atan(s * t, z * rho);
              // atan(t z / (s rho)) - atan(t / s) = -atan(s t / (s^2 + z (z + rho))) and likewise in the
              // other direction: no branch, as the divisor is positive.
              chixx += sign * safe_atan(s * t, s * s + z * (z + rho));
              chiyy += sign * safe_atan(s * t, t * t + z * (z + rho));
              chixy += sign * std::log(z + rho);
              vxx += sign * s * inverse_t;
              vyy += sign * t * inverse_s;
              vxy += sign / rho;
              vxz += sign * z * inverse_t;
              vyz += sign * z * inverse_s;
            });
    const double vzz = -vxx - vyy;
    Eigen::Matrix3d stress;
    // sigma = lambda tr(eps) I + 2 mu eps of the displacement above, with 4 pi G taken out; div u = 2 (1-2
    // nu) V_z / (4 pi G).
    stress(0, 0) = 2 * nu * vz - k * chixx - z * vxx;
    stress(1, 1) = 2 * nu * vz - k * chiyy - z * vyy;
    stress(2, 2) = vz - z * vzz;
    stress(0, 1) = stress(1, 0) = -k * chixy - z * vxy;
    stress(0, 2) = stress(2, 0) = -z * vxz;
    stress(1, 2) = stress(2, 1) = -z * vyz;
    return scale * stress;
  }

  Eigen::Vector3d boussinesq_displacement(const Eigen::Vector3d &p, const double youngs_modulus,
                                          const double nu)
  {
    const double inverse = 1 / p.norm(), square = p.z() * inverse * inverse,
                 scale = (1 + nu) / (2 * pi * youngs_modulus) * inverse;
    const double lateral = scale * (square - (1 - 2 * nu) * inverse / (1 + p.z() * inverse));
    return { p.x() * lateral, p.y() * lateral, scale * (p.z() * square + 2 * (1 - nu)) };
  }

  Eigen::Matrix3d boussinesq_stress(const Eigen::Vector3d &p, const double nu)
  {
    // -3 z p p'/rho^5, and what vanishes for nu = 1/2 in the plane of the surface.
    const double inverse = 1 / p.norm(), inverse3 = inverse * inverse * inverse, z = p.z(),
                 scale = 1 / (2 * pi), k = scale * (1 - 2 * nu);
    const double of_sum = 1 / (1 + z * inverse), first = z * inverse3 - inverse * inverse * of_sum,
                 second = (2 + z * inverse) * inverse3 * inverse * (of_sum * of_sum);
    Eigen::Matrix3d s = -3 * scale * z * inverse3 * inverse * inverse * p * p.transpose();
    s.topLeftCorner<2, 2>() += k * second * p.head<2>() * p.head<2>().transpose();
    s(0, 0) += k * first;
    s(1, 1) += k * first;
    return s;
  }
} // namespace flank::half_space
