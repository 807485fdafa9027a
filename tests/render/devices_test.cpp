// Devices that share a render: the bits of one, whatever the shares. A software driver serves as two.
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "checkpoint.h"
#include "error.h"
#include "image_io.h"
#include "support/command_folder.h"
#include "support/images.h"
#include "support/scenes.h"
#include "support/test_device.h"

using namespace vkvol;
using Catch::Contains;

namespace {

// The tests' device once more. Each test has its own, since none may outlive main.
struct Another {
    const Device device{{std::to_string(test_device().info().index), false, false}};
};

RenderJob shared_job(const Scene& scene, Schedule schedule, const Another& other) {
    RenderJob job;
    job.seed = 7;
    job.disk_cache = false;
    job.crop = {0, scene.picture.width, 0, scene.picture.height};
    job.plan.schedule = schedule;
    job.others = {&other.device};
    return job;
}

RenderJob alone(RenderJob job) {
    job.others.clear();
    return job;
}

double part_of_first(const RenderResult& result) {
    double part = 1.0;
    for (const OtherDevice& other : result.others)
        part -= other.part;
    return part;
}

} // namespace

TEST_CASE("devices share a picture, and its bits are those of one", "[gpu][devices]") {
    const Schedule schedule = GENERATE(Schedule::fused, Schedule::staged);
    const int kind = GENERATE(0, 1, 2);
    Scene scene = sunlit_cloud(40, 11);
    const Another second, third;
    RenderJob job = shared_job(scene, schedule, second);
    if (kind == 0)
        job.crop = {3, 40, 5, 38};
    if (kind == 1) // four bands
        job.plan.most_film_bytes = 12 * 40 * sizeof(shared::FilmPixel);
    if (kind == 2) {
        scene.layers = layer_emission | layer_direct | layer_depth;
        job.others.push_back(&third.device);
    }
    job.plan.most_batch = 2; // so that shares change
    const RenderResult one = render(test_device(), scene, alone(job)), all = render(test_device(), scene, job);
    CHECK(all.others.size() == job.others.size());
    CHECK(part_of_first(all) > 0.0);
    CHECK(part_of_first(all) < 1.0);
    CHECK(all.counts.paths == one.counts.paths);
    CHECK(all.counts.real_collisions == one.counts.real_collisions);
    CHECK(all.counts.shadow_rays == one.counts.shadow_rays);
    CHECK((same_bits(all.film, one.film) || !test_device().is_cpu()));
}

TEST_CASE("what moves is shared at every moment", "[gpu][devices]") {
    Scene scene = sunlit_cloud(40, 9);
    scene.motion_blur = std::make_shared<MotionBlur>(MotionBlur{0.0, 1.0, [](double time) {
                                                                    Scene then = sunlit_cloud(40, 9);
                                                                    then.volumes.front().sigma_s *= 1.0 + time;
                                                                    return then;
                                                                }});
    const Another second;
    const RenderJob job = shared_job(scene, Schedule::fused, second);
    CHECK((same_bits(render(test_device(), scene, job).film, render(test_device(), scene, alone(job)).film) ||
           !test_device().is_cpu()));
}

TEST_CASE("a shared render is looked at, stopped and gone on with", "[gpu][devices][checkpoint]") {
    const Scene scene = sunlit_cloud(40, 9);
    const Another second;
    RenderJob job = shared_job(scene, GENERATE(Schedule::fused, Schedule::staged), second);
    job.plan.slots = 64;
    job.plan.submit_seconds = 0.0; // a round each, however fast the device
    const Film whole = render(test_device(), scene, alone(job)).film;
    int looks = 0;
    std::vector<Checkpoint> kept;
    job.interrupted = [&] { return kept.size() > 2; };
    job.checkpoint = [&](const Checkpoint& checkpoint) { kept.push_back(checkpoint); };
    job.preview = [&](const RenderResult& result) {
        const std::vector<std::uint32_t>& samples = result.film.samples;
        ++looks;
        REQUIRE(samples.size() == 1600);
        CHECK(*std::min_element(samples.begin(), samples.end()) >= result.samples); // of all devices
    };
    const RenderResult begun = render(test_device(), scene, job);
    REQUIRE(begun.interrupted);
    CHECK(looks > 0);
    CHECK(kept.back().pixels.has_value());
    for (const std::size_t i : {kept.size() / 2, kept.size() - 1}) {
        RenderJob rest = shared_job(scene, job.plan.schedule, second);
        rest.resume = &kept[i];
        const RenderResult gone_on = render(test_device(), scene, rest);
        CHECK((same_bits(gone_on.film, whole) || !test_device().is_cpu()));
        CHECK(part_of_first(gone_on) > 0.0);
        CHECK(part_of_first(gone_on) < 1.0);
        CHECK((same_bits(render(test_device(), scene, alone(rest)).film, whole) || !test_device().is_cpu()));
    }
}

TEST_CASE("samples of several devices are wanted in several goes", "[gpu][devices]") {
    const Scene scene = sunlit_cloud(40, 11);
    const Another second;
    const RenderJob job = shared_job(scene, Schedule::fused, second);
    Session session(test_device(), scene, job);
    for (const std::uint32_t samples : {1u, 4u, 11u})
        session.render(samples);
    CHECK((same_bits(session.result().film, render(test_device(), scene, alone(job)).film) || !test_device().is_cpu()));
}

TEST_CASE("particles, which reach any pixel, are one device's", "[gpu][devices]") {
    Scene scene = sunlit_cloud(40, 11);
    scene.settings.integrator = "lightTracing";
    const Another second;
    CHECK_THROWS_WITH(render(test_device(), scene, shared_job(scene, Schedule::fused, second)),
                      Contains("--sample-offset"));
}

TEST_CASE("a device of no name is none", "[gpu][devices]") {
    CHECK_THROWS_AS(Device(DeviceOptions{"", false, false}), DeviceError);
}

TEST_CASE("the command line names several devices", "[gpu][devices][command]") {
    const Folder folder("");
    const std::string number = std::to_string(test_device().info().index), both = number + "," + number;
    const auto vkvol = [&](const std::string& arguments, const std::string& device) {
        return folder.script("\"$vkvol\" " + arguments + " --device " + device);
    };
    REQUIRE(vkvol("ball.xml -q --seed 3 -o one.exr", number).code == exit_done);
    const Run run = vkvol("ball.xml --seed 3 -o both.exr --report both.json", both);
    CHECK(run.code == exit_done);
    CHECK_THAT(run.text, Contains(" + "));
    Metadata metadata;
    CHECK((same_bits(read_exr(folder.file("one.exr")), read_exr(folder.file("both.exr"), &metadata)) ||
           !test_device().is_cpu()));
    CHECK_THAT(std::get<std::string>(metadata.at("vkvol/device")), Contains(" + "));
    const nlohmann::json report = nlohmann::json::parse(folder.text("both.json"));
    CHECK(report["otherDevices"].size() == 1);
    CHECK(report["otherDevices"][0]["name"] == report["device"]["name"]);
    CHECK(report["otherDevices"][0]["part"].get<double>() > 0.0);
    CHECK_THAT(vkvol("ball.xml", number + ",").text, Contains("a number is missing"));
    CHECK_THAT(vkvol("ball.xml", number + ",99").text, Contains("99"));
    CHECK_THAT(vkvol("bench ball.xml", both).text, Contains("name one"));
}

TEST_CASE("a list of devices with a gap is a wrong command line", "[gpu][devices][command]") {
    const Folder folder("");
    const std::string number = std::to_string(test_device().info().index);
    CHECK(folder.script("\"$vkvol\" ball.xml -o a.exr --device " + number + ",").code == exit_bad_input);
    CHECK(folder.script("\"$vkvol\" bench ball.xml --device " + number + "," + number).code == exit_bad_input);
}
