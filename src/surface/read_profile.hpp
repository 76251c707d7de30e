#pragma once

#include <memory>
#include <string>

#include "core/thrown_error.hpp"
#include "io/container/formats.hpp"
#include "slipfit/surface/surface.hpp"
#include "surface/areal.hpp"

// Converters to a profile or a map, one for each kind of file. Errors are thrown (ThrownError): read_profile returns
// them.

namespace slipfit::surface {

/// A file that is open and is read once, to its end.
struct SurfaceFile {
  std::string name;  ///< as messages show it
  std::shared_ptr<reading::TextStream> stream;
};

/// Columns of text. Errors: those of opening a text file, no_unit, no_pitch, unknown_column, ambiguous_columns.
Profile read_text_profile(const SurfaceFile& file, const ProfileOptions& options);

/// ISO 25178-71, ASCII ("aISO-1.0") and binary ("bISO-1.0"). Errors: damaged_surface, map_too_large.
HeightMap read_sdf(const SurfaceFile& file);

/// ISO 25178-72. Errors: not_built_in, damaged_surface, map_too_large, those of a zip archive.
HeightMap read_x3p(const SurfaceFile& file);

/// PNG, TIFF or JPEG through the program slipfit-image. Errors: no_pixel, not_built_in, damaged_container.
HeightMap read_image(const SurfaceFile& file, const ProfileOptions& options);

ThrownError damaged_surface(const SurfaceFile& file, const std::string& what);

/// The whole file, at most `most` bytes. Errors: those of opening a file, map_too_large.
std::string whole_file(const SurfaceFile& file, std::size_t most);

}  // namespace slipfit::surface
