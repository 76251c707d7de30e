#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// Files of MATLAB 5 to 7 are elements one after another, each a type, a number of bytes and these bytes. Source:
// "MAT-File Format", The MathWorks, 2017, chapter 1.

namespace slipfit::reading {

/// What the bytes of an element are: numbers of one kind, or elements.
enum class MatType : std::uint32_t {
  Int8 = 1,
  UInt8 = 2,
  Int16 = 3,
  UInt16 = 4,
  Int32 = 5,
  UInt32 = 6,
  Single = 7,
  Double = 9,
  Int64 = 12,
  UInt64 = 13,
  Matrix = 14,
  Compressed = 15,
};

enum class MatOrder { AsHere, Swapped };  ///< of the bytes of a number

struct MatElement {
  MatType type{};
  std::string_view data;
  MatOrder order = MatOrder::AsHere;
};

/// The elements in `bytes`, which end with the last one. Throws Refusal where they do not.
std::vector<MatElement> mat_elements(std::string_view bytes, MatOrder order);

/// The numbers of an element, whatever their kind. Throws Refusal where it holds none, or half a number.
std::vector<double> mat_numbers(const MatElement& element);

/// The bytes of a compressed element. Throws Refusal where their checksum is wrong, or they are out of all proportion.
std::string inflated(std::string_view packed);

[[noreturn]] void refuse_damaged_mat();

}  // namespace slipfit::reading
