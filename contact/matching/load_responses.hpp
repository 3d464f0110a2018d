// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Core>

#include <array>
#include <span>
#include <type_traits>
#include <vector>

namespace flank
{
  /// What several loads do at several places, as many loads side by side as a processor's vectors take;
  /// filled up with zeros.
  class LoadResponses
  {
  public:
    static constexpr int width = EIGEN_MAX_STATIC_ALIGN_BYTES >= 64 ? 8 : 4;

    LoadResponses() = default;
    LoadResponses(const Eigen::Index loads, const Eigen::Index places)
        : LoadResponses(loads, Values::Zero(width, (loads + width - 1) / width * places))
    {
    }

    /// Responses through a matrix: the place rows[r] gets the sum over k of matrix(rows[r], columns[k]) times
    /// on(load, k). The other ones of the `places` places are left unset.
    template <class Matrix>
    static LoadResponses through(const Matrix &matrix, const std::vector<int> &rows,
                                 const std::vector<int> &columns, const LoadResponses &on,
                                 const Eigen::Index places)
    {
      LoadResponses result(on.loads_, Values(width, on.packs() * places));
      for_packs(on.packs(), [&]<int Packs>(const Eigen::Index first, std::integral_constant<int, Packs>) {
        std::size_t r = 0;
        for (; r + 4 <= rows.size(); r += 4)
          result.template multiply<Packs, 4>(first, matrix, &rows[r], columns, on);
        for (; r < rows.size(); ++r)
          result.template multiply<Packs, 1>(first, matrix, &rows[r], columns, on);
      });
      return result;
    }

    double &operator()(const Eigen::Index load, const Eigen::Index place)
    {
      return values_(load % width, place * packs() + load / width);
    }

    /// Adds each load's mean over some places, counted from `first_place`, by weights, to sum[load].
    void add_mean(const std::span<const double> weight, const std::span<const int> places,
                  const int first_place, Eigen::Ref<Eigen::VectorXd> sum) const
    {
      for_packs(packs(), [&]<int Packs>(const Eigen::Index first, std::integral_constant<int, Packs>) {
        std::array<Pack, Packs> part;
        part.fill(Pack::Zero());
        for (std::size_t k = 0; k < weight.size(); ++k)
          for (int p = 0; p < Packs; ++p)
            part[p] += weight[k] * at(first + p, places[k] - first_place);
        for (int p = 0; p < Packs; ++p)
          if (const Eigen::Index rest = sum.size() - (first + p) * width; rest >= width)
            sum.segment<width>((first + p) * width) += part[p];
          else
            sum.tail(rest) += part[p].head(rest);
      });
    }

  private:
    using Pack = Eigen::Matrix<double, width, 1>;
    using Values = Eigen::Matrix<double, width, Eigen::Dynamic>;

    LoadResponses(const Eigen::Index loads, Values values)
        : loads_(loads)
        , values_(std::move(values))
    {
    }

    Values::ConstColXpr at(const Eigen::Index pack, const Eigen::Index place) const
    {
      return values_.col(place * packs() + pack);
    }

    Eigen::Index packs() const { return (loads_ + width - 1) / width; }

    /// work(first, number) for all packs, three at a time while there are: enough sums under way to keep the
    /// processor busy.
    template <class Work>
    static void for_packs(const Eigen::Index packs, const Work &work)
    {
      Eigen::Index first = 0;
      for (; first + 3 <= packs; first += 3)
        work(first, std::integral_constant<int, 3>());
      if (packs - first == 2)
        work(first, std::integral_constant<int, 2>());
      else if (packs - first == 1)
        work(first, std::integral_constant<int, 1>());
    }

    template <int Packs, int Rows, class Matrix>
    void multiply(const Eigen::Index first, const Matrix &matrix, const int *rows,
                  const std::vector<int> &columns, const LoadResponses &on)
    {
      std::array<std::array<Pack, Rows>, Packs> sum;
      for (auto &of_pack : sum)
        of_pack.fill(Pack::Zero());
      for (std::size_t k = 0; k < columns.size(); ++k)
        for (int p = 0; p < Packs; ++p)
          {
            const Pack load = on.at(first + p, static_cast<Eigen::Index>(k));
            for (int r = 0; r < Rows; ++r)
              sum[p][r] += matrix(rows[r], columns[k]) * load;
          }
      for (int p = 0; p < Packs; ++p)
        for (int r = 0; r < Rows; ++r)
          values_.col(rows[r] * packs() + first + p) = sum[p][r];
    }

    Eigen::Index loads_ = 0;
    Values values_; ///< a place's packs lie together
  };
} // namespace flank
