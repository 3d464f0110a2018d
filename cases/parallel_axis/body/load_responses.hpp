// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Core>

#include <vector>

namespace flank
{
  /// What several loads do at several places, eight loads side by side, as a processor's vectors take them; filled up with zeros.
  class LoadResponses
  {
  public:
    static constexpr int width = 8;

    LoadResponses() = default;
    LoadResponses(const Eigen::Index loads, const Eigen::Index places)
        : places_(places)
        , values_(Values::Zero(width, (loads + width - 1) / width * places))
    {
    }

    /// Of a matrix with a row a place, a column a load.
    explicit LoadResponses(const Eigen::MatrixXd &m)
        : LoadResponses(m.cols(), m.rows())
    {
      for (Eigen::Index load = 0; load < m.cols(); ++load)
        for (Eigen::Index place = 0; place < m.rows(); ++place)
          (*this)(load, place) = m(place, load);
    }

    double &operator()(const Eigen::Index load, const Eigen::Index place) { return values_(load % width, load / width * places_ + place); }

    /// Adds to some places, those of the rows, what the loads make through a matrix: on(load, k) acts on its column columns[k].
    template <class Matrix>
    void add(const Matrix &matrix, const std::vector<int> &rows, const std::vector<int> &columns, const LoadResponses &on)
    {
      for (Eigen::Index eight = 0; eight < eights(); ++eight)
        for (const int row : rows)
          {
            Eight sum = at(eight, row);
            for (std::size_t k = 0; k < columns.size(); ++k)
              sum += matrix(row, columns[k]) * on.at(eight, static_cast<Eigen::Index>(k));
            values_.col(eight * places_ + row) = sum;
          }
    }

    /// Adds each load's mean over some places, by weights, to sum[load].
    void add_mean(const std::vector<double> &weight, const std::vector<int> &places, Eigen::Ref<Eigen::VectorXd> sum) const
    {
      for (Eigen::Index eight = 0; eight < eights(); ++eight)
        {
          Eight part = Eight::Zero();
          for (std::size_t k = 0; k < weight.size(); ++k)
            part += weight[k] * at(eight, places[k]);
          if (const Eigen::Index rest = sum.size() - eight * width; rest >= width)
            sum.segment<width>(eight * width) += part;
          else
            sum.tail(rest) += part.head(rest);
        }
    }

  private:
    using Eight  = Eigen::Matrix<double, width, 1>;
    using Values = Eigen::Matrix<double, width, Eigen::Dynamic>;

    Values::ConstColXpr at(const Eigen::Index eight, const Eigen::Index place) const { return values_.col(eight * places_ + place); }

    Eigen::Index eights() const { return places_ ? values_.cols() / places_ : 0; }

    Eigen::Index places_ = 0;
    Values       values_;
  };
} // namespace flank
