#include "batch/build.hpp"

#include <sys/utsname.h>

#include "batch/build_identity.hpp"

namespace slipfit::batch {

std::string build_of_program() {
  return kBuild;
}

std::string processor_of_machine() {
  struct utsname machine {};
  std::string processor = ::uname(&machine) == 0 ? std::string(static_cast<const char*>(machine.machine)) : "unknown";
#ifdef __x86_64__
  if (__builtin_cpu_supports("fma")) processor += " fma";
  if (__builtin_cpu_supports("avx2")) processor += " avx2";
  if (__builtin_cpu_supports("avx512f")) processor += " avx512f";
#endif
  return processor;
}

}  // namespace slipfit::batch
