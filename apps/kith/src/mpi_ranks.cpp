#include "mpi_ranks.hpp"

#ifdef KITH_MPI
#include <dlfcn.h>
#include <mpi.h>  // for its version only

#include <cstdlib>
#include <stdexcept>
#include <string>
#endif

namespace kith::cli {

#ifdef KITH_MPI
namespace {

// mpirun and srun say so in the environment; without them MPI is not even loaded.
bool several_were_started() {
  for (const auto* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    const char* value = std::getenv(name);
    if (value != nullptr && std::strtol(value, nullptr, 10) > 1) return true;
  }
  return false;
}

}  // namespace

std::unique_ptr<Ranks> mpi_ranks() {
  if (!several_were_started()) return nullptr;
  // Found by the program's run path. MPI's own plugins look for its symbols, hence global.
  void* const module = dlopen("kith_mpi.so", RTLD_NOW | RTLD_GLOBAL);
  void* const create = module != nullptr ? dlsym(module, "kith_mpi_ranks") : nullptr;
  if (create == nullptr) throw std::runtime_error{"cannot load MPI: " + std::string{dlerror()}};
  return std::unique_ptr<Ranks>{reinterpret_cast<Ranks* (*)()>(create)()};
}

const char* mpi_version() {
#ifdef OMPI_MAJOR_VERSION
#define KITH_TEXT_OF(x) #x
#define KITH_TEXT(x) KITH_TEXT_OF(x)
  return "Open MPI " KITH_TEXT(OMPI_MAJOR_VERSION) "." KITH_TEXT(OMPI_MINOR_VERSION) "." KITH_TEXT(
      OMPI_RELEASE_VERSION);
#undef KITH_TEXT
#undef KITH_TEXT_OF
#else
  return "some MPI";
#endif
}

#else

std::unique_ptr<Ranks> mpi_ranks() { return nullptr; }
const char* mpi_version() { return "none"; }

#endif

}  // namespace kith::cli
