// EXR files as merge and compare are given them.
#include <OpenImageIO/imageio.h>
#include <cstdlib>

#include "compare.h"
#include "image_io.h"
#include "merge.h"
#include "mutate.h"
#include "target.h"

namespace vkvol::fuzz {

namespace {

Film make_film(int width, int height, Crop crop) {
    Film film;
    film.picture_width = width;
    film.picture_height = height;
    film.crop = crop;
    for (int i = 0; i < film.width() * film.height(); ++i) {
        film.mean.emplace_back(0.1f * float(i), 1.0f, 0.5f);
        film.variance.emplace_back(0.01f, 0.0f, 1e-6f * float(i));
        film.samples.push_back(16u + std::uint32_t(i % 2));
    }
    return film;
}

// Another program's file: tiles, halves, fewer channels.
void write_foreign(const std::filesystem::path& file, const char* compression, OIIO::TypeDesc type, int tile) {
    OIIO::ImageSpec spec(20, 12, 4, type);
    spec.channelnames = {"R", "G", "B", "A"};
    spec.attribute("compression", compression);
    spec.tile_width = spec.tile_height = tile;
    const std::vector<float> pixels(20 * 12 * 4, 0.25f);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(file.string());
    if (!output || !output->open(file.string(), spec) || !output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()))
        throw std::runtime_error("no EXR file can be made");
    output->close();
}

class ImageTarget : public Target {
public:
    ImageTarget() : Target("image", ".exr", 256, 1040) {}

    void prepare(const std::filesystem::path& directory) override {
        OIIO::attribute("threads", 1);
        OIIO::attribute("exr_threads", 1);
        file_ = directory / "input.exr";
        const auto keep = [&] { // without the time of writing: an input is always the same
            const std::string date = std::string("capDate\0string\0\x13\0\0\0", 19);
            std::string bytes = read_file(file_);
            if (const std::size_t at = bytes.find(date); at != std::string::npos)
                bytes.replace(at + date.size(), 19, "2000:01:01 00:00:00");
            corpus_.push_back(bytes);
        };
        const Metadata metadata = {{"samplesPerPixel", 16},      {"renderTimeSeconds", 1.5f}, {"Software", "vkvol 0"},
                                   {"vkvol/sceneHash", "0123"},  {"vkvol/seed", 42},          {"vkvol/sampleOffset", 0},
                                   {"vkvol/integrator", "delta"}};
        write_exr(file_, make_film(16, 12, {0, 16, 0, 12}), metadata);
        keep();
        write_exr(file_, make_film(16, 12, {0, 8, 0, 12}), metadata);
        keep();
        write_exr(file_, make_film(16, 12, {8, 16, 0, 12}), metadata);
        keep();
        write_exr(file_, make_film(1, 1, {0, 1, 0, 1}), {});
        keep();
        for (const char* compression : {"none", "rle", "zip", "zips", "piz", "pxr24", "b44", "b44a", "dwaa"}) {
            write_foreign(file_, compression, OIIO::TypeDesc::HALF, 0);
            keep();
        }
        write_foreign(file_, "zip", OIIO::TypeDesc::FLOAT, 8);
        keep();
        for (std::size_t i = 0; i < 4; ++i) {
            write_file(file_, corpus_[i]);
            MergeInput input{"valid.exr", {}, {}};
            input.film = read_exr(file_, &input.metadata);
            valid_.push_back(std::move(input));
        }
    }

    std::string make(Random& random) override {
        std::string file = random.pick(corpus_);
        if (random.one_in(2)) // the header
            put_interesting(std::as_writable_bytes(std::span(file)),
                            random.below(std::min<std::size_t>(file.size(), 900)), random);
        else
            mutate_bytes(file, random, random.pick(corpus_));
        return file;
    }

    void use(const std::string& input, Random& random) override {
        write_file(file_, input);
        MergeInput read{"input.exr", {}, {}};
        read.film = read_exr(file_, &read.metadata);
        const Film& film = read.film;
        expect(film.width() > 0 && film.height() > 0, "a film has no pixels");
        expect(film.mean.size() == std::size_t(film.width()) * std::size_t(film.height()) &&
                   film.variance.size() == film.mean.size() && film.samples.size() == film.mean.size(),
               "a film has another size than its window says");
        compare_films(film, film, {});
        const MergeInput& other = random.pick(valid_);
        if (film.width() == other.film.width() && film.height() == other.film.height()) {
            CompareOptions options;
            Film placed = other.film;
            placed.crop = film.crop;
            placed.picture_width = film.picture_width;
            placed.picture_height = film.picture_height;
            compare_films(film, placed, options);
            compare_films(placed, film, options);
        }
        if (film.pixel_count() < 100'000 && std::abs(film.crop.x0) < 1000 && std::abs(film.crop.y0) < 1000)
            merge_films({read, other});
    }

private:
    std::filesystem::path file_;
    std::vector<std::string> corpus_;
    std::vector<MergeInput> valid_;
};

} // namespace

Target& image_target() {
    static ImageTarget target;
    return target;
}

} // namespace vkvol::fuzz
