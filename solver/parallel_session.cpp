// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/parallel_session.hpp"

#include "mesh/base/parallel.hpp"
#include "solver/libraries/element_libraries.hpp"

#include <mpi.h>
#include <petscversion.h>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <mutex>
#include <new>
#include <string>
#include <utility>
#include <vector>

namespace flank
{
  namespace
  {
    /// A lone process sends no messages: with wrong settings, which are for those that do, MPI would end it.
    /// Where a moved Open MPI lies stays, if it lies there.
    void take_no_settings_of_mpi()
    {
      std::vector<std::string> names;
      for (char **entry = environ; *entry; ++entry)
        names.push_back(std::string(*entry).substr(0, std::strcspn(*entry, "=")));
      const char *prefix = std::getenv("OPAL_PREFIX");
      std::error_code error;
      const bool lies_there =
          prefix && std::filesystem::is_directory(std::string(prefix) + "/share/openmpi", error);
      for (const std::string &name : names)
        if (name.starts_with("OMPI_MCA_") || name.starts_with("PMIX_MCA_") ||
            (name.starts_with("OPAL_") && !(name == "OPAL_PREFIX" && lies_there)))
          unsetenv(name.c_str());
    }

    /// Without mpirun Open MPI would start a daemon of its own first, for processes that are never spawned
    /// (half a second), and look for network hardware that a lone process does not use (a quarter). Folders
    /// for processes to meet in are not made either: two lone ones that begin and end at the same time take
    /// them away from each other.
    void stand_alone()
    {
      if (std::getenv("OMPI_COMM_WORLD_SIZE") || std::getenv("PMIX_RANK"))
        return;
      take_no_settings_of_mpi();
      for (const auto &[setting, value] : { std::pair{ "OMPI_MCA_mca_base_param_files", "none" },
                                            { "OMPI_MCA_ess_singleton_isolated", "1" },
                                            { "OMPI_MCA_pml", "ob1" },
                                            { "OMPI_MCA_btl", "self" },
                                            { "OMPI_MCA_osc", "^ucx,pt2pt" },
                                            { "OMPI_MCA_orte_create_session_dirs", "0" } })
        setenv(setting, value, 1);
    }

    /// OpenBLAS knows processors by their models and gives one that is newer than itself its oldest kernels,
    /// with which a condensation takes twice as long. What the processor can do is asked instead: the same
    /// kernels, and so the same last bits, whichever models OpenBLAS has heard of. Elsewhere it chooses.
    void choose_kernels_of_blas()
    {
      unsetenv("OPENBLAS_CORETYPE");
#if defined(__x86_64__)
      __builtin_cpu_init();
      if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
          __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
        setenv("OPENBLAS_CORETYPE", "SkylakeX", 1);
      else if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        setenv("OPENBLAS_CORETYPE", "Haswell", 1);
#endif
    }

    /// What libraries would take from the environment beside what they are asked for: PETSc another
    /// factorisation, deal.II and OpenBLAS threads and kernels, which may be forbidden, nonsense, or change
    /// the last bits.
    void take_no_settings_from_outside()
    {
      for (const char *name : { "PETSC_OPTIONS", "PETSC_OPTIONS_YAML", "DEAL_II_NUM_THREADS" })
        unsetenv(name);
      setenv("OPENBLAS_NUM_THREADS", "1", 1);
      choose_kernels_of_blas();
    }

    /// Shared memory that processes which are gone left behind, between making it and letting go of its name.
    void sweep_shared_memory()
    {
      std::error_code error;
      for (const auto &entry : std::filesystem::directory_iterator("/dev/shm", error))
        {
          const std::string name = entry.path().filename();
          int owner = 0, number = 0;
          char rest = 0;
          struct stat status = {};
          if (std::sscanf(name.c_str(), "flank-%9d-%9d%c", &owner, &number, &rest) == 2 &&
              lstat(entry.path().c_str(), &status) == 0 && S_ISREG(status.st_mode) &&
              status.st_uid == geteuid() && kill(owner, 0) != 0 && errno == ESRCH)
            shm_unlink(("/" + name).c_str());
        }
    }

    /// MPI says lines of its own where it cannot have the stack of its thread. Throws std::bad_alloc.
    void require_addresses_for_mpi()
    {
      constexpr std::size_t bytes = 1u << 25;
      void *place = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
      if (place == MAP_FAILED)
        throw std::bad_alloc();
      munmap(place, bytes);
    }

    constexpr std::size_t most_at_once = 1u << 30; // MPI counts are 32 bit
  }                                                // namespace

  ParallelSession::ParallelSession(int &argc, char **&argv)
  {
    require_addresses_for_mpi();
    stand_alone();
    take_no_settings_from_outside();
    sweep_shared_memory();
    int provided = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
    MPI_Comm node;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node);
    MPI_Comm_size(node, &on_node_);
    // Where mpirun binds every rank to cores of its own, those are its share already.
    cpu_set_t set;
    const int cores = machine_cores(),
              own = sched_getaffinity(0, sizeof(set), &set) == 0 ? CPU_COUNT(&set) : cores;
    MPI_Comm_free(&node);
    const bool bound = own < cores && own * on_node_ <= cores;
    share_cores(bound ? 1 : on_node_);
  }

  ParallelSession::~ParallelSession()
  {
    finish_element_libraries();
    MPI_Finalize();
  }

  int ParallelSession::ranks() const
  {
    int result;
    MPI_Comm_size(MPI_COMM_WORLD, &result);
    return result;
  }

  int ParallelSession::rank() const
  {
    int result;
    MPI_Comm_rank(MPI_COMM_WORLD, &result);
    return result;
  }

  int ParallelSession::ranks_on_node() const
  {
    return on_node_;
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
            MPI_Send(bytes.data() + at, static_cast<int>(std::min(most_at_once, bytes.size() - at)), MPI_BYTE,
                     0, 2, MPI_COMM_WORLD);
        }
      else if (rank() == 0)
        {
          unsigned long long size = 0;
          MPI_Recv(&size, 1, MPI_UNSIGNED_LONG_LONG, from, 1, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
          result.emplace_back(size);
          for (std::size_t at = 0; at < size; at += most_at_once)
            MPI_Recv(result.back().data() + at,
                     static_cast<int>(std::min<std::size_t>(most_at_once, size - at)), MPI_BYTE, from, 2,
                     MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        }
    return result;
  }

  namespace
  {
    /// A communicator that frees itself.
    struct Communicator
    {
      MPI_Comm comm = MPI_COMM_NULL;
      ~Communicator()
      {
        if (comm != MPI_COMM_NULL)
          MPI_Comm_free(&comm);
      }
      int rank() const
      {
        int r;
        MPI_Comm_rank(comm, &r);
        return r;
      }
    };

    void broadcast_within(const MPI_Comm comm, char *bytes, const std::size_t size)
    {
      for (std::size_t at = 0; at < size; at += most_at_once)
        MPI_Bcast(bytes + at, static_cast<int>(std::min(most_at_once, size - at)), MPI_BYTE, 0, comm);
    }

    /// Shared memory of a name: made (and its pages reserved) by one process, opened by others. Null where
    /// that is not possible.
    char *map_shared(const std::string &name, const std::size_t size, const bool make)
    {
      const int file = shm_open(name.c_str(), make ? O_CREAT | O_EXCL | O_RDWR : O_RDONLY, 0600);
      if (file < 0)
        return nullptr;
      void *memory = MAP_FAILED;
      if (!make || posix_fallocate(file, 0, static_cast<off_t>(size)) == 0)
        memory = mmap(nullptr, size, make ? PROT_READ | PROT_WRITE : PROT_READ, MAP_SHARED, file, 0);
      close(file);
      return memory == MAP_FAILED ? nullptr : static_cast<char *>(memory);
    }
  } // namespace

  void ParallelSession::broadcast(std::vector<char> &bytes) const
  {
    if (ranks() == 1)
      return;
    unsigned long long size = bytes.size();
    MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG_LONG, 0, MPI_COMM_WORLD);
    bytes.resize(size);
    broadcast_within(MPI_COMM_WORLD, bytes.data(), size);
  }

  SharedBytes ParallelSession::share(const SharedBytes &bytes, const int from) const
  {
    if (ranks() == 1)
      return bytes;
    unsigned long long size = bytes.size;
    MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG_LONG, from, MPI_COMM_WORLD);

    // The first rank of every node receives the bytes where its neighbours can read them; `from` leads its
    // node and the leaders.
    const int order = rank() == from ? 0 : 1 + rank();
    Communicator node, leaders;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, order, MPI_INFO_NULL, &node.comm);
    const bool leader = node.rank() == 0;
    MPI_Comm_split(MPI_COMM_WORLD, leader ? 0 : MPI_UNDEFINED, order, &leaders.comm);
    static int count = 0;
    char name[64] = {};
    if (leader)
      fmt::format_to_n(name, sizeof name - 1, "/flank-{}-{}", getpid(), count++);
    MPI_Bcast(name, sizeof name, MPI_CHAR, 0, node.comm);
    char *memory = leader ? map_shared(name, size, true) : nullptr;
    MPI_Barrier(node.comm);
    if (!leader)
      memory = map_shared(name, size, false);
    int mapped = memory != nullptr, all_mapped = 0;
    MPI_Allreduce(&mapped, &all_mapped, 1, MPI_INT, MPI_MIN, node.comm);
    if (leader)
      shm_unlink(name); // it lives on as long as somebody has it mapped
    SharedBytes result;
    if (memory)
      result = { std::shared_ptr<const void>(memory,
                                             [size](const void *m) { munmap(const_cast<void *>(m), size); }),
                 memory, size };
    std::vector<char> own;
    if (!all_mapped)
      {
        if (leader)
          spdlog::warn(
              "no room for shared memory: every process of this node keeps its own copy of {:.0f} MB",
              1e-6 * size);
        own.assign(bytes.data, bytes.data + bytes.size);
        own.resize(size);
        memory = own.data();
      }
    else if (rank() == from)
      std::copy_n(bytes.data, bytes.size, memory);
    if (leader)
      broadcast_within(leaders.comm, memory, size);
    if (!all_mapped)
      {
        broadcast_within(node.comm, memory, size);
        return SharedBytes(std::move(own));
      }
    MPI_Barrier(node.comm);
    return result;
  }

  void ParallelSession::add_to_root(double *values, const std::ptrdiff_t count) const
  {
    constexpr std::ptrdiff_t most = 1 << 27;
    for (std::ptrdiff_t at = 0; at < count; at += most)
      MPI_Reduce(rank() == 0 ? MPI_IN_PLACE : values + at, rank() == 0 ? values + at : nullptr,
                 static_cast<int>(std::min(most, count - at)), MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
  }

  bool ParallelSession::any(const bool here) const
  {
    int result = here;
    MPI_Allreduce(MPI_IN_PLACE, &result, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    return result != 0;
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

  struct SharedCounter::Implementation
  {
    std::mutex mutex; // MPI is called by one thread at a time
    long alone = 0;
    long *memory = nullptr; // on rank 0
    MPI_Win window = MPI_WIN_NULL;
  };

  SharedCounter::SharedCounter(const ParallelSession &session)
      : implementation_(std::make_unique<Implementation>())
  {
    if (session.ranks() == 1)
      return;
    MPI_Win_allocate(session.rank() == 0 ? sizeof(long) : 0, sizeof(long), MPI_INFO_NULL, MPI_COMM_WORLD,
                     &implementation_->memory, &implementation_->window);
    MPI_Win_lock_all(0, implementation_->window);
    if (session.rank() == 0)
      {
        *implementation_->memory = 0;
        MPI_Win_sync(implementation_->window);
      }
    MPI_Barrier(MPI_COMM_WORLD);
  }

  SharedCounter::~SharedCounter()
  {
    // To free it all ranks must come here, which they do not where an exception of this one alone is under
    // way: it ends them.
    if (implementation_->window == MPI_WIN_NULL || std::uncaught_exceptions() > 0)
      return;
    MPI_Win_unlock_all(implementation_->window);
    MPI_Win_free(&implementation_->window);
  }

  long SharedCounter::next()
  {
    const std::lock_guard lock(implementation_->mutex);
    if (implementation_->window == MPI_WIN_NULL)
      return implementation_->alone++;
    const long one = 1;
    long result = 0;
    MPI_Fetch_and_op(&one, &result, MPI_LONG, 0, 0, MPI_SUM, implementation_->window);
    MPI_Win_flush(0, implementation_->window);
    return result;
  }

  std::string solver_libraries()
  {
    char mpi[MPI_MAX_LIBRARY_VERSION_STRING];
    int length = 0;
    MPI_Get_library_version(mpi, &length);
    const std::string mpi_text(mpi, length);
    return fmt::format("PETSc {}.{}.{} with MUMPS\n{}\n", PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR,
                       PETSC_VERSION_SUBMINOR, mpi_text.substr(0, mpi_text.find(',')));
  }
} // namespace flank
