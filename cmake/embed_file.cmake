# cmake -DINPUT=FILE -DOUTPUT=FILE.cpp -DFUNCTION=NAME -P embed_file.cmake: the file's bytes as slipfit::assets::NAME().
# Without INPUT the function returns nothing.
set(bytes "")
if(INPUT)
  file(READ "${INPUT}" bytes HEX)
  # "//# sourceMappingURL=...": a page from disk has no such file, and browsers would look for it.
  string(REPLACE "2f2f2320736f757263654d617070696e6755524c" "2f2f2020736f757263654d617070696e6755524c" bytes "${bytes}")
  string(REPLACE "2f2a2320736f757263654d617070696e6755524c" "2f2a2020736f757263654d617070696e6755524c" bytes "${bytes}")
  string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
endif()
file(WRITE "${OUTPUT}" "// Made by cmake/embed_file.cmake from ${INPUT}
#include \"report/html/assets.hpp\"

namespace {
constexpr unsigned char kBytes[] = {
${bytes}0};
}  // namespace

std::string_view slipfit::assets::${FUNCTION}() {
  return {reinterpret_cast<const char*>(kBytes), sizeof(kBytes) - 1};
}
")
