// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/base/errors.hpp"

#include <string>
#include <vector>

/// The message that wrong input is refused with by `read`; empty if it is accepted.
template <class Read>
std::string refusal_of(const Read &read)
{
  try
    {
      read();
    }
  catch (const flank::InputError &error)
    {
      return error.what();
    }
  return "";
}

/// One line that names all of `parts`.
inline bool holds(const std::string &text, const std::vector<std::string> &parts)
{
  for (const std::string &part : parts)
    if (text.find(part) == std::string::npos)
      return false;
  return text.find('\n') == std::string::npos;
}
