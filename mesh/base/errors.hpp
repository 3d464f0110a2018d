// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace flank
{
  /// Wrong user data. `quantity` names what the error is about, such as "pinion tip diameter" (may be empty);
  /// the reader of the case file adds the key by which the case gives it. The message says what is wrong with
  /// numbers, what is allowed and what to do. Exit code 2.
  struct InputError : std::runtime_error
  {
    explicit InputError(const std::string &message, std::string quantity = {})
        : std::runtime_error(message)
        , quantity(std::move(quantity))
    {
    }
    std::string quantity;
  };

  /// A computation that did not converge or failed its certificate, with its numbers. Exit code 3.
  struct ComputationError : std::runtime_error
  {
    using std::runtime_error::runtime_error;
  };

  /// A computation error that every rank meets alike; rank 0 alone reports it.
  struct SharedComputationError : ComputationError
  {
    using ComputationError::ComputationError;
  };

  /// Results that cannot be written, such as on a full disk. What was finished before stays in the journal.
  /// Exit code 3.
  struct OutputError : std::runtime_error
  {
    using std::runtime_error::runtime_error;
  };

  /// A library that cannot be loaded, does not start or fails by itself: nothing that the case is to blame
  /// for. What was finished before stays in the journal. Exit code 3.
  struct LibraryError : std::runtime_error
  {
    using std::runtime_error::runtime_error;
  };

  /// Bytes that were read from a disk and are not what they should be. What they held is computed again.
  struct UnusableRecord : std::runtime_error
  {
    using std::runtime_error::runtime_error;
  };

  /// Throws std::logic_error with the place: our own mistake, checked in every build type.
  [[noreturn]] void assertion_failed(const char *condition, const char *file, int line,
                                     const std::string &numbers);
} // namespace flank

#define FLANK_ASSERT(condition, numbers)                                                                     \
  do                                                                                                         \
    {                                                                                                        \
      if (!(condition))                                                                                      \
        ::flank::assertion_failed(#condition, __FILE__, __LINE__, (numbers));                                \
    }                                                                                                        \
  while (false)
