// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Dense>

#include <memory>
#include <new>
#include <vector>

namespace flank
{
  /// Bytes that are read only and may be shared with other processes; they live as long as `memory`.
  struct SharedBytes
  {
    SharedBytes() = default;
    SharedBytes(std::shared_ptr<const void> memory, const char *data, const std::size_t size)
        : memory(std::move(memory))
        , data(data)
        , size(size)
    {
    }
    explicit SharedBytes(std::vector<char> own)
    {
      auto kept = std::make_shared<const std::vector<char>>(std::move(own));
      data = kept->data();
      size = kept->size();
      memory = std::move(kept);
    }

    std::shared_ptr<const void> memory;
    const char *data = nullptr;
    std::size_t size = 0;
  };

  /// A matrix that is read only: one of its own, or a view of shared bytes. Copies share the memory.
  class SharedMatrix : public Eigen::Map<const Eigen::MatrixXd>
  {
    using View = Eigen::Map<const Eigen::MatrixXd>;

  public:
    SharedMatrix()
        : View(nullptr, 0, 0)
    {
    }
    SharedMatrix(Eigen::MatrixXd own)
        : SharedMatrix(std::make_shared<const Eigen::MatrixXd>(std::move(own)))
    {
    }
    SharedMatrix(std::shared_ptr<const void> memory, const double *data, const Eigen::Index rows,
                 const Eigen::Index cols)
        : View(data, rows, cols)
        , memory_(std::move(memory))
    {
    }
    SharedMatrix(const SharedMatrix &) = default;
    SharedMatrix &operator=(const SharedMatrix &other)
    {
      std::shared_ptr<const void> kept = other.memory_;
      new (static_cast<View *>(this))
          View(other.data(), other.rows(), other.cols()); // how Eigen lets a view be pointed elsewhere
      memory_ = std::move(kept);
      return *this;
    }

  private:
    explicit SharedMatrix(std::shared_ptr<const Eigen::MatrixXd> own)
        : View(own->data(), own->rows(), own->cols())
        , memory_(std::move(own))
    {
    }
    std::shared_ptr<const void> memory_;
  };
} // namespace flank
