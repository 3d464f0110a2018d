// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/parallel_session.hpp"

#include "mesh/base/parallel.hpp"

#include <deal.II/base/mpi.h>

#include <petscsys.h>

#include <fmt/format.h>

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace flank
{
  struct ParallelSession::Implementation
  {
    dealii::Utilities::MPI::MPI_InitFinalize session;
    int                                      on_node = 1;
  };

  namespace
  {
    /// Without mpirun Open MPI would start a daemon of its own first, for processes that are never spawned (half a second), and look for
    /// network hardware that a lone process does not use (a quarter).
    void stand_alone()
    {
      if (std::getenv("OMPI_COMM_WORLD_SIZE") || std::getenv("PMIX_RANK"))
        return;
      for (const auto &[setting, value] :
           { std::pair{ "OMPI_MCA_ess_singleton_isolated", "1" }, { "OMPI_MCA_pml", "ob1" }, { "OMPI_MCA_btl", "self" } })
        setenv(setting, value, 0);
    }

    constexpr std::size_t most_at_once = 1u << 30; // MPI counts are 32 bit
  }                                                // namespace

  ParallelSession::ParallelSession(int &argc, char **&argv)
      : implementation_((stand_alone(), new Implementation{ { argc, argv, 1 } }))
  {
    MPI_Comm node;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node);
    MPI_Comm_size(node, &implementation_->on_node);
    // Where mpirun binds every rank to cores of its own, those are its share already.
    cpu_set_t  set;
    const long cores = sysconf(_SC_NPROCESSORS_ONLN), own = sched_getaffinity(0, sizeof(set), &set) == 0 ? CPU_COUNT(&set) : cores;
    MPI_Comm_free(&node);
    const bool bound = own < cores && own * implementation_->on_node <= cores;
    share_cores(bound ? 1 : implementation_->on_node);
  }

  ParallelSession::~ParallelSession()
  {
    delete implementation_;
  }

  int ParallelSession::ranks() const
  {
    return static_cast<int>(dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
  }

  int ParallelSession::rank() const
  {
    return static_cast<int>(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
  }

  int ParallelSession::ranks_on_node() const
  {
    return implementation_->on_node;
  }

  std::vector<std::vector<char>> ParallelSession::gather(const std::vector<char> &bytes) const
  {
    std::vector<std::vector<char>> result;
    if (rank() == 0)
      result.push_back(bytes);
    for (int from = 1; from < ranks(); ++from)
      if (rank() == from)
        {
          const unsigned long long size = bytes.size();
          MPI_Send(&size, 1, MPI_UNSIGNED_LONG_LONG, 0, 1, MPI_COMM_WORLD);
          for (std::size_t at = 0; at < bytes.size(); at += most_at_once)
            MPI_Send(bytes.data() + at, static_cast<int>(std::min(most_at_once, bytes.size() - at)), MPI_BYTE, 0, 2, MPI_COMM_WORLD);
        }
      else if (rank() == 0)
        {
          unsigned long long size = 0;
          MPI_Recv(&size, 1, MPI_UNSIGNED_LONG_LONG, from, 1, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
          result.emplace_back(size);
          for (std::size_t at = 0; at < size; at += most_at_once)
            MPI_Recv(result.back().data() + at, static_cast<int>(std::min<std::size_t>(most_at_once, size - at)), MPI_BYTE, from, 2,
                     MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        }
    return result;
  }

  void ParallelSession::broadcast(std::vector<char> &bytes) const
  {
    if (ranks() == 1)
      return;
    unsigned long long size = bytes.size();
    MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG_LONG, 0, MPI_COMM_WORLD);
    bytes.resize(size);
    for (std::size_t at = 0; at < size; at += most_at_once)
      MPI_Bcast(bytes.data() + at, static_cast<int>(std::min<std::size_t>(most_at_once, size - at)), MPI_BYTE, 0, MPI_COMM_WORLD);
  }

  void ParallelSession::add_to_root(double *values, const std::ptrdiff_t count) const
  {
    constexpr std::ptrdiff_t most = 1 << 27;
    for (std::ptrdiff_t at = 0; at < count; at += most)
      MPI_Reduce(rank() == 0 ? MPI_IN_PLACE : values + at, rank() == 0 ? values + at : nullptr,
                 static_cast<int>(std::min(most, count - at)), MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
  }

  void ParallelSession::wait() const
  {
    MPI_Barrier(MPI_COMM_WORLD);
  }

  void ParallelSession::abort(const int exit_code) const
  {
    MPI_Abort(MPI_COMM_WORLD, exit_code);
    std::abort();
  }

  std::string solver_libraries()
  {
    char mpi[MPI_MAX_LIBRARY_VERSION_STRING];
    int  length = 0;
    MPI_Get_library_version(mpi, &length);
    const std::string mpi_text(mpi, length);
    return fmt::format("PETSc {}.{}.{} with MUMPS\n{}\n", PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, PETSC_VERSION_SUBMINOR,
                       mpi_text.substr(0, mpi_text.find(',')));
  }
} // namespace flank
