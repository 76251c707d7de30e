// The range algorithms that slipfit uses, for emscripten's libc++ 13, which has none. CMake includes this file before
// every source of the browser version (CMakePresets.json, preset web); other builds never see it. A missing algorithm
// is an error of that build: scripts/lint.py knows it, and scripts/web_layer.sh compiles most layers in CI.
#pragma once

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 14000  // later ones have their own

namespace std::ranges {

/// `function` applied to the projection of an element, as the standard's algorithms apply predicates.
template <class Function, class Projection>
constexpr auto on_projection(Function& function, Projection& projection) {
  return [&function, &projection](auto&&... elements) -> decltype(auto) {
    return std::invoke(function, std::invoke(projection, std::forward<decltype(elements)>(elements))...);
  };
}

template <class Range, class Predicate, class Projection = std::identity>
constexpr bool all_of(Range&& range, Predicate predicate, Projection projection = {}) {
  return std::all_of(std::begin(range), std::end(range), on_projection(predicate, projection));
}
template <class Range, class Predicate, class Projection = std::identity>
constexpr bool any_of(Range&& range, Predicate predicate, Projection projection = {}) {
  return std::any_of(std::begin(range), std::end(range), on_projection(predicate, projection));
}
template <class Range, class Predicate, class Projection = std::identity>
constexpr bool none_of(Range&& range, Predicate predicate, Projection projection = {}) {
  return std::none_of(std::begin(range), std::end(range), on_projection(predicate, projection));
}
template <class Range, class Predicate, class Projection = std::identity>
constexpr auto count_if(Range&& range, Predicate predicate, Projection projection = {}) {
  return std::count_if(std::begin(range), std::end(range), on_projection(predicate, projection));
}
template <class Range, class Predicate, class Projection = std::identity>
constexpr auto find_if(Range&& range, Predicate predicate, Projection projection = {}) {
  return std::find_if(std::begin(range), std::end(range), on_projection(predicate, projection));
}
template <class Range, class Predicate, class Projection = std::identity>
constexpr auto find_if_not(Range&& range, Predicate predicate, Projection projection = {}) {
  return std::find_if_not(std::begin(range), std::end(range), on_projection(predicate, projection));
}
template <class Range, class Value, class Projection = std::identity>
constexpr auto count(Range&& range, const Value& value, Projection projection = {}) {
  return ranges::count_if(
      range, [&value](const auto& element) { return element == value; }, projection);
}
template <class Range, class Value, class Projection = std::identity>
constexpr auto find(Range&& range, const Value& value, Projection projection = {}) {
  return ranges::find_if(
      range, [&value](const auto& element) { return element == value; }, projection);
}
template <class Range, class Value, class Less = std::less<>, class Projection = std::identity>
constexpr auto lower_bound(Range&& range, const Value& value, Less less = {}, Projection projection = {}) {
  return std::lower_bound(std::begin(range), std::end(range), value, [&](const auto& element, const auto& bound) {
    return std::invoke(less, std::invoke(projection, element), bound);
  });
}
template <class Range, class Predicate = std::equal_to<>, class Projection = std::identity>
constexpr auto adjacent_find(Range&& range, Predicate predicate = {}, Projection projection = {}) {
  return std::adjacent_find(std::begin(range), std::end(range), on_projection(predicate, projection));
}
template <class Range, class Out, class Predicate>
constexpr Out copy_if(Range&& range, Out out, Predicate predicate) {
  return std::copy_if(std::begin(range), std::end(range), out, predicate);
}
template <class Range, class Other>
constexpr bool equal(Range&& range, Other&& other) {
  return std::equal(std::begin(range), std::end(range), std::begin(other), std::end(other));
}
template <class Range, class Value>
constexpr void replace(Range&& range, const Value& before, const Value& after) {
  std::replace(std::begin(range), std::end(range), before, after);
}
template <class Range>
constexpr void reverse(Range&& range) {
  std::reverse(std::begin(range), std::end(range));
}
template <class Range, class Generator>
constexpr void generate(Range&& range, Generator generator) {
  std::generate(std::begin(range), std::end(range), std::move(generator));
}
template <class Range, class Less = std::less<>, class Projection = std::identity>
constexpr void sort(Range&& range, Less less = {}, Projection projection = {}) {
  std::sort(std::begin(range), std::end(range), on_projection(less, projection));
}
template <class Range, class Less = std::less<>, class Projection = std::identity>
constexpr void stable_sort(Range&& range, Less less = {}, Projection projection = {}) {
  std::stable_sort(std::begin(range), std::end(range), on_projection(less, projection));
}
template <class Range, class Less = std::less<>, class Projection = std::identity>
constexpr auto min_element(Range&& range, Less less = {}, Projection projection = {}) {
  return std::min_element(std::begin(range), std::end(range), on_projection(less, projection));
}
template <class Range, class Less = std::less<>, class Projection = std::identity>
constexpr auto max_element(Range&& range, Less less = {}, Projection projection = {}) {
  return std::max_element(std::begin(range), std::end(range), on_projection(less, projection));
}
template <class Iterator>
struct FirstAndLastElement {
  Iterator min;
  Iterator max;
};
template <class Range, class Less = std::less<>, class Projection = std::identity>
constexpr auto minmax_element(Range&& range, Less less = {}, Projection projection = {}) {
  const auto found = std::minmax_element(std::begin(range), std::end(range), on_projection(less, projection));
  return FirstAndLastElement<decltype(std::begin(range))>{found.first, found.second};
}

}  // namespace std::ranges

#endif
