// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/stress/fillet_stress.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>

namespace flank
{
  namespace
  {
    constexpr int arc_points = 5; // of an element's edge along the fillet

    /// Elements with a face on one fillet in one layer, and where on them the surface is: reference
    /// coordinate and its value.
    struct FilletElements
    {
      std::vector<int> cells;
      int axis;
      double at;
    };

    /// The fillet's upper half belongs to the tooth, its lower half to the rim.
    std::vector<FilletElements> fillet_elements(const ToothSector &sector, const int side, const int layer)
    {
      const ToothSection &section = sector.section;
      const SectorResolution &size = sector.resolution;
      FilletElements tooth{ {}, 1, side == 0 ? 0.0 : 1.0 }, rim{ {}, 0, 0.0 };
      const int column = side == 0 ? 0 : section.tooth_columns() - 1;
      for (int row = section.tooth_rows() - size.fillet_rows; row < section.tooth_rows(); ++row)
        tooth.cells.push_back(sector.tooth_cell(row, column, layer));
      const int first = side == 0 ? size.root_land_columns
                                  : size.root_land_columns + size.fillet_columns + section.tooth_columns();
      for (int c = 0; c < size.fillet_columns; ++c)
        rim.cells.push_back(sector.rim_cell(first + c, 0, layer));
      return { tooth, rim };
    }

    struct ArcSample
    {
      Eigen::Vector3d position;
      double stress;
    };

    /// Greatest value of the polynomial of arc length that fits the samples best. [MPa]
    double greatest_over_arc(std::vector<ArcSample> samples)
    {
      constexpr int degree = 4, places = 101;
      std::sort(samples.begin(), samples.end(),
                [](const ArcSample &a, const ArcSample &b) { // from the root circle outwards
                  return a.position.head<2>().squaredNorm() < b.position.head<2>().squaredNorm();
                });
      const auto n = static_cast<Eigen::Index>(samples.size());
      Eigen::VectorXd along(n), stress(n);
      for (Eigen::Index k = 0; k < n; ++k)
        {
          along[k] = k == 0 ? 0 : along[k - 1] + (samples[k].position - samples[k - 1].position).norm();
          stress[k] = samples[k].stress;
        }
      along = 2 * along / along[n - 1] - Eigen::VectorXd::Ones(n);
      const auto terms = [](const Eigen::VectorXd &x) {
        Eigen::MatrixXd result(x.size(), degree + 1);
        result.col(0).setOnes();
        for (int d = 1; d <= degree; ++d)
          result.col(d) = result.col(d - 1).cwiseProduct(x);
        return result;
      };
      const Eigen::VectorXd coefficients = terms(along).householderQr().solve(stress);
      return (terms(Eigen::VectorXd::LinSpaced(places, -1, 1)) * coefficients).maxCoeff();
    }
  } // namespace

  std::array<std::vector<double>, 2> fillet_stress(const BodyElements &elements,
                                                   const Eigen::VectorXd &displacement)
  {
    const ToothSector &sector = elements.sector();
    const ElasticBody &body = elements.body();
    const int p = body.degree(), layers = sector.resolution.face_layers;
    std::array<std::vector<double>, 2> result;
    for (const int side : { 0, 1 })
      {
        struct Point
        {
          Eigen::Vector3d position;
          Eigen::Matrix3d sum; ///< of what the elements that meet there say
          int elements;
        };
        std::vector<std::vector<Point>> at(
            static_cast<std::size_t>(layers * p + 1)); // [node along the face][point of the arc]
        for (int layer = 0; layer < layers; ++layer)
          for (const FilletElements &part : fillet_elements(sector, side, layer))
            {
              std::vector<Eigen::Vector3d> points;
              for (int k = 0; k <= p; ++k)
                for (int a = 0; a < arc_points; ++a)
                  {
                    Eigen::Vector3d point(0, 0, body.abscissas()[k]);
                    point[part.axis] = part.at;
                    point[1 - part.axis] = a / (arc_points - 1.0);
                    points.push_back(point);
                  }
              body.each_sample(part.cells, points, displacement, [&](int, const ElasticBody::Samples &s) {
                for (Eigen::Index q = 0; q < s.position.cols(); ++q)
                  {
                    std::vector<Point> &of_node = at[layer * p + q / arc_points];
                    const auto there = std::find_if(of_node.begin(), of_node.end(), [&](const Point &point) {
                      return (point.position - s.position.col(q)).squaredNorm() < 1e-18; // 1e-9 mm: rounding
                    });
                    Point &point =
                        there != of_node.end()
                            ? *there
                            : of_node.emplace_back(Point{ s.position.col(q), Eigen::Matrix3d::Zero(), 0 });
                    point.sum += stress_tensor(s.stress.col(q));
                    ++point.elements;
                  }
              });
            }
        for (const std::vector<Point> &of_node : at)
          {
            std::vector<ArcSample> samples;
            for (const Point &point : of_node)
              samples.push_back({ point.position, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(
                                                      point.sum / point.elements, Eigen::EigenvaluesOnly)
                                                      .eigenvalues()[2] });
            result[side].push_back(greatest_over_arc(std::move(samples)));
          }
      }
    return result;
  }
} // namespace flank
