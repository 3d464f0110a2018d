// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/solve/problem_file.hpp"

#include "contact/solve/certificate.hpp"

#include <charconv>
#include <cmath>
#include <istream>
#include <ostream>
#include <stdexcept>

namespace flank
{
  namespace
  {
    void expect(std::istream &in, const std::string &word)
    {
      std::string found;
      if (!(in >> found) || found != word)
        throw std::runtime_error("expected \"" + word + "\"" +
                                 (found.empty() ? ", the file ends here" : ", found \"" + found + "\""));
    }

    double number(std::istream &in, const std::string &what)
    {
      std::string text;
      if (!(in >> text))
        throw std::runtime_error(what + " is missing: the file ends here");
      double value = 0;
      const char *first = text.data() + (text.front() == '+'), *last = text.data() + text.size();
      const auto [end, problem] = std::from_chars(first, last, value);
      if (problem != std::errc() || end != last || !std::isfinite(value))
        throw std::runtime_error(what + " is \"" + text + "\": not a finite number");
      return value;
    }
  } // namespace

  ProblemFile read_problem(std::istream &in)
  {
    ProblemFile file;
    expect(in, "LCP1");
    // The name is what stands before "n".
    for (std::string word; in >> word && word != "n";)
      file.name += (file.name.empty() ? "" : " ") + word;
    if (!in)
      throw std::runtime_error("expected \"n\" after the name, the file ends here");
    const double n = number(in, "n");
    if (n != std::floor(n) || n < 1 || n > 100000)
      throw std::runtime_error("n must be an integer from 1 to 100000");
    expect(in, "T");
    file.torque = number(in, "T");
    expect(in, "sym");
    const double symmetric = number(in, "sym");
    if (symmetric != 0 && symmetric != 1)
      throw std::runtime_error("sym must be 0 or 1");
    const auto size = static_cast<Eigen::Index>(n);
    ContactProblem &problem = file.problem;
    problem.symmetric = symmetric == 1;
    problem.lever.resize(size);
    problem.gap.resize(size);
    expect(in, "l");
    for (Eigen::Index i = 0; i < size; ++i)
      problem.lever[i] = number(in, "l, number " + std::to_string(i + 1));
    expect(in, "g");
    for (Eigen::Index i = 0; i < size; ++i)
      problem.gap[i] = number(in, "g, number " + std::to_string(i + 1));
    expect(in, "C");
    std::vector<double> rows; // grows with what the file really holds
    for (Eigen::Index i = 0; i < size; ++i)
      for (Eigen::Index j = 0; j < size; ++j)
        rows.push_back(number(in, "C, row " + std::to_string(i + 1) + ", number " + std::to_string(j + 1)));
    problem.compliance =
        Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(rows.data(),
                                                                                                 size, size);
    for (Eigen::Index i = 0; i < size; ++i)
      if (!(problem.compliance(i, i) > 0))
        throw std::runtime_error("C, row " + std::to_string(i + 1) + ": the diagonal must be greater than 0");
    if (problem.symmetric && problem.asymmetry() > 1e-12)
      throw std::runtime_error("sym is 1, but C differs from its transpose by " +
                               std::to_string(problem.asymmetry()) + " of its greatest entry; give sym 0");
    if (std::string more; in >> more)
      throw std::runtime_error("after the last number of C there is \"" + more + "\"");
    return file;
  }

  void write_problem(std::ostream &out, const ProblemFile &file)
  {
    out.precision(17);
    out << "LCP1 " << file.name << "\nn " << file.problem.size() << "\nT " << file.torque << "\nsym "
        << (file.problem.symmetric ? 1 : 0) << "\nl";
    for (const double value : file.problem.lever)
      out << ' ' << value;
    out << "\ng";
    for (const double value : file.problem.gap)
      out << ' ' << value;
    out << "\nC\n";
    for (Eigen::Index i = 0; i < file.problem.size(); ++i)
      for (Eigen::Index j = 0; j < file.problem.size(); ++j)
        out << file.problem.compliance(i, j) << (j + 1 < file.problem.size() ? ' ' : '\n');
  }

  bool write_answer(std::ostream &out, const ContactProblem &problem, const ContactSolution &solution)
  {
    const Certificate certificate = certify(problem, solution);
    const bool good = solution.status == Status::solved && certificate.holds();
    out.precision(17);
    out << "status "
        << (good                                    ? "OK"
            : solution.status == Status::infeasible ? "INFEASIBLE"
                                                    : "FAILED")
        << "\ntheta " << solution.theta << "\ncertificate " << certificate.worst() << "\npivots "
        << solution.pivots << "\np";
    for (Eigen::Index i = 0; i < problem.size(); ++i)
      out << ' ' << (solution.force.size() == problem.size() ? solution.force[i] : 0.0);
    out << '\n';
    return good;
  }
} // namespace flank
