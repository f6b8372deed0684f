#include "engine/store/hdf5/hdf5_calls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace sluice {
namespace {

herr_t keep_first_reason(unsigned index, const H5E_error2_t* error, void* reason) {
  if (index == 0 && error->desc != nullptr) {
    *static_cast<std::string*>(reason) = error->desc;
  }
  return 0;
}

/// The innermost reason of the failure that this thread met last.
std::string last_reason() {
  std::string reason = "no reason given";
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first_reason, &reason);
  return reason;
}

}  // namespace

void silence_hdf5() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

void Hdf5Checker::fail(std::string_view action, std::string_view path) const {
  throw StorageError(fault_, fmt::format("HDF5 cannot {} {}: {}", action, path, last_reason()));
}

Hdf5Handle Hdf5Checker::text_type() const {
  Hdf5Handle type = own(H5Tcopy(H5T_C_S1), H5Tclose, "make a type for", "texts");
  require(H5Tset_size(type.get(), H5T_VARIABLE) >= 0, "size the type for", "texts");
  require(H5Tset_cset(type.get(), H5T_CSET_UTF8) >= 0, "set UTF-8 for", "texts");
  return type;
}

ElementType element_type(hid_t type) {
  if (H5Tequal(type, H5T_IEEE_F64LE) > 0) {
    return ElementType::float64;
  }
  if (H5Tequal(type, H5T_IEEE_F32LE) > 0) {
    return ElementType::float32;
  }
  if (H5Tequal(type, H5T_STD_U64LE) > 0) {
    return ElementType::uint64;
  }
  return H5Tis_variable_str(type) > 0 ? ElementType::text : ElementType::other;
}

Extents shape_of(hid_t space) {
  const int rank = H5Sget_simple_extent_ndims(space);
  std::vector<hsize_t> lengths(static_cast<std::size_t>(std::max(rank, 0)));
  H5Sget_simple_extent_dims(space, lengths.data(), nullptr);
  return {lengths.begin(), lengths.end()};
}

}  // namespace sluice
