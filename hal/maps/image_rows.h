#pragma once
// The picture formats behind ImageFile.
#include <string>

#include "hal/maps/image_file.h"

namespace jaywalk::sim {

class ImageFile::Rows {
 public:
  virtual ~Rows() = default;
  virtual void next(std::vector<Pixel>& row) = 0;

  std::int32_t width = 0, height = 0;

 protected:
  explicit Rows(std::filesystem::path file) : file_(std::move(file)) {}
  [[noreturn]] void refuse(const std::string& cause) const;
  void take_size(std::int64_t wide, std::int64_t high);

  std::filesystem::path file_;
};

[[nodiscard]] std::unique_ptr<ImageFile::Rows> png_rows(const std::filesystem::path& file);
[[nodiscard]] std::unique_ptr<ImageFile::Rows> pgm_rows(const std::filesystem::path& file);
[[nodiscard]] std::unique_ptr<ImageFile::Rows> bmp_rows(const std::filesystem::path& file);

}  // namespace jaywalk::sim
