# cmake -DFOLDERS="src;include" -DCOMPILER=TEXT -DOUTPUT=FILE.hpp -P build_identity.cmake: kBuild, which names the compiler and the
# digest of all sources: programs of the same build give the same bytes.
foreach(folder IN LISTS FOLDERS)
  file(GLOB_RECURSE found "${folder}/*.cpp" "${folder}/*.hpp")
  list(APPEND sources ${found})
endforeach()
list(SORT sources)
set(digests "")
foreach(source IN LISTS sources)
  file(SHA256 "${source}" digest)
  string(APPEND digests "${digest}")
endforeach()
string(SHA256 digest "${digests}")
string(SUBSTRING "${digest}" 0 12 digest)
file(WRITE "${OUTPUT}" "#pragma once

namespace slipfit::batch {

inline constexpr const char* kBuild = \"${COMPILER}, sources ${digest}\";

}  // namespace slipfit::batch
")
