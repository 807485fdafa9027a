#include "dry_run.h"

#include <fmt/format.h>

#include "messages.h"
#include "render_notes.h"
#include "requested_scene.h"

namespace vkvol {

namespace {

std::string picture_text(const RenderOptions& options, const Picture& picture) {
    const Crop crop = resolve_crop(options.crop, picture);
    std::string text = fmt::format("{}x{} pixels", picture.width, picture.height);
    if (options.crop)
        text += fmt::format(" (of these {},{},{},{})", crop.x0, crop.x1, crop.y0, crop.y1);
    return text;
}

std::string samples_text(const RenderOptions& options, std::uint32_t spp) {
    const std::string at_most = options.time_limit ? fmt::format(", {:g} s at most", *options.time_limit) : "";
    const std::string or_noise =
        options.noise_goal ? fmt::format(", until the noise is {:g} %", 100.0 * *options.noise_goal) : "";
    if (options.noise_goal && !options.spp)
        return "samples" + or_noise + at_most;
    if (options.time_limit && !options.spp)
        return fmt::format("as many samples as {:g} s allow", *options.time_limit);
    return fmt::format("{} {} per pixel{}{}", spp, spp == 1 ? "sample" : "samples", or_noise, at_most);
}

} // namespace

void print_dry_run(const RenderOptions& options, const Scene& scene, const Device& device, const RenderResult& result) {
    const auto frame = options.defines.find("F");
    tell(stdout, "{}{}: {}, {}, {} ({})\n", options.scene.string(),
         frame == options.defines.end() ? "" : fmt::format(", frame {}", frame->second),
         picture_text(options, scene.picture), samples_text(options, scene.settings.spp), result.integrator,
         result.biased.empty() ? "unbiased" : "biased: " + result.biased);
    tell(stdout, "  {}\n", result.specialization);
    tell(stdout, "  on {}{}, {:.1f} MiB of its memory\n", of_all_devices(device, result, &DeviceInfo::name),
         device.is_cpu() ? " (software)" : "", double(result.device_bytes) / 1048576.0);
    std::string files;
    for (const std::filesystem::path& output : options.outputs)
        files += (files.empty() ? "" : ", ") + output.string();
    if (options.report)
        files += (files.empty() ? "" : ", ") + options.report->string();
    tell(stdout, "  would write {}\n", files.empty() ? "nothing" : files);
}

} // namespace vkvol
