#pragma once
// One RAII wrapper for all of HDF5's handles.

#include <filesystem>
#include <hdf5.h>
#include <stdexcept>
#include <string>
#include <utility>

namespace concord::scene {

/// Owns an HDF5 identifier and closes it with the function given. Throws std::runtime_error
/// when HDF5 returned an error instead of an identifier.
class Hdf5Handle {
 public:
  Hdf5Handle(hid_t id, herr_t (*close)(hid_t), const std::string& what)
      : m_id(id), m_close(close) {
    if (id < 0) throw std::runtime_error("HDF5 cannot " + what);
  }
  Hdf5Handle(Hdf5Handle&& other) noexcept
      : m_id(std::exchange(other.m_id, -1)), m_close(other.m_close) {}
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;
  ~Hdf5Handle() {
    if (m_id >= 0) m_close(m_id);
  }
  operator hid_t() const noexcept { return m_id; }
  /// The caller closes it from now on.
  hid_t release() noexcept { return std::exchange(m_id, -1); }

 private:
  hid_t m_id;
  herr_t (*m_close)(hid_t);
};

/// HDF5 prints its errors unless told not to; while one of these lives, they become exceptions
/// alone.
class QuietHdf5 {
 public:
  QuietHdf5() {
    H5Eget_auto2(H5E_DEFAULT, &m_function, &m_data);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~QuietHdf5() { H5Eset_auto2(H5E_DEFAULT, m_function, m_data); }
  QuietHdf5(const QuietHdf5&) = delete;
  QuietHdf5& operator=(const QuietHdf5&) = delete;

 private:
  H5E_auto2_t m_function = nullptr;
  void* m_data = nullptr;
};

/// Throws std::runtime_error when an HDF5 call failed.
inline void hdf5_check(herr_t status, const std::string& what) {
  if (status < 0) throw std::runtime_error("HDF5 cannot " + what);
}

}  // namespace concord::scene
