#include "python_picture.h"

#include "device_shop.h"
#include "file_ending.h"
#include "image_io.h"

namespace vkvol::python {

void write_picture(const PythonPicture& picture, const std::filesystem::path& file, const ToneRequest& tone) {
    check_writable(file);
    if (file_ending(file) == ".exr") // whose library waits for threads that stayed with the first process
        check_not_forked();
    Metadata metadata = picture.metadata;
    record_tone(tone, metadata);
    write_image(file, picture.film, metadata, choose_tone(tone, picture.film, metadata).mapping);
}

std::vector<std::uint8_t> developed(const PythonPicture& picture, const ToneRequest& tone) {
    return tone_map(picture.film, choose_tone(tone, picture.film, picture.metadata).mapping);
}

} // namespace vkvol::python
