#!/bin/bash
# Tests the tests: makes one error at a time in a copy of the sources, rebuilds, and requires that the tests named for
# it fail. Keeps which error was caught by what, and at which commit, in tools/results/mutations.txt. Fails if an error
# survives, if the text that it replaces is no longer in the sources, or if the tests fail without any error.
#
#   tools/mutation_check.sh [WORD]       WORD: only the errors whose name contains it
#   tools/mutation_check.sh --minutes N  begins no further error after so long
#   tools/mutation_check.sh --share K/N  every Nth of the errors, from the Kth on: N runs at a time, each in a DIR of its own
#   tools/mutation_check.sh --dry-run    only whether every text to be replaced is there, and how many rows are of now
#   MUTATION_DIR=DIR                     where the copy and its build are kept
#
# A row is of now as long as the row itself, the code around the error and the test that caught it are the same
# (tools/mutation_keys.py); others are made again, those that were never made first. All takes some hours on two cores.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
dry_run= only= minutes=1000000 share=1/1
while [ $# -gt 0 ]; do
    case $1 in
    -h | --help)
        sed -n '2,/^set /s/^# \?//p' "$0"
        exit
        ;;
    --dry-run) dry_run=yes ;;
    --minutes) minutes=${2:?--minutes needs a number}; shift ;;
    --share) share=${2:?--share needs K/N}; shift ;;
    *) only=$1 ;;
    esac
    shift
done
results=$root/tools/results/mutations.txt
tab=$(printf '\t')
work=${MUTATION_DIR:-${TMPDIR:-/tmp}/vkvol-mutation}
copy=$work/source
build=$work/build

# name ~ file ~ text ~ replacement ~ tests (a Catch2 specification). "^" parts several texts and their replacements.
mutations() {
    cat <<'END'
heights lost where all of a placing is undone at once ~ host/assets/placement.cpp ~ if (!loaded.is_layered) ~ if (true) ~ [layers]
pictures where their files put them on paper ~ host/codec/oiio_codec.cpp ~ if (has_windows) ~ if (true) ~ [image_io]
boards too small for what they state ~ host/image/image_input.cpp ~ header.is_whole_numbers ? 8 * 1040 * header.channels.size() : 1040 ~ 260 ~ [image_io]
exposures of maps not told ~ host/image/radiance_map.cpp ~ exposure != 1.0) ~ exposure == -1.0) ~ [image_io]
checkpoints of other kernels ~ host/render/program.cpp ~ "{} (kernels {})", version, kernels_digest() ~ "{}", version ~ [checkpoint]
files replaced for everybody to see ~ host/base/atomic_file.cpp ~ fchmod(descriptor_, before.st_mode & (has_group ? 0777 : 0707)); ~ (void)has_group; ~ [image_io]
places of attributes that are not there ~ host/scene_files/xml_reader.cpp ~ found ? document_->place(found) : place() ~ document_->place(found) ~ [xml]
numbers too small to be held too large ~ host/base/number_text.cpp ~ read.is_number && !is_small(text) ~ read.is_number ~ [xml]
fields without a file have none of --grid's ~ host/scene_files/scene_shape.cpp ~ if (!overrides_.grid) // whose ~ if (true) // whose ~ [xml]
what is above a link to a folder ~ host/scene_files/scene_shape.cpp ~ !std::filesystem::equivalent(whole, shorter, error) ~ false ~ [xml]
faces that are there twice ~ host/fields/mesh.cpp ~ check_fills(bodies, name); ~ ; ~ [mesh]
lamps before one another seen evenly ~ shaders/lights/lamp.glsl ~ float weight = alike ? 1.0 : bright, before ~ float weight = 1.0, before ~ [lights]
long lamps as large as from their middle ~ shaders/lights/lamp.glsl ~ light.kind == LIGHT_SPHERE ? dot(apart, apart) : flat_square(light, from) ~ dot(apart, apart) ~ [lights]
particles for rows beyond a pole ~ host/methods/particle_scenes.cpp ~ && shows_beyond_poles(scene.picture) ~ && false ~ [particles]
floors as sure as without a bias ~ host/bench/bench_statistics.cpp ~ if (mean > half_width) // there ~ if (false) // there ~ [bench]
efficiencies sure whatever the reference ~ host/bench/bench_statistics.cpp ~ normal_two_sided(0.95) * offset_error * log->slope)); ~ 0.0)); ~ [bench]
variances known from more than passes ~ host/cli/compare.cpp ~ std::min(parts_of(a, pixel), parts_of(b, pixel)) - 1 ~ std::min(n_a, n_b) - 1 ~ [compare]
sketches exposed as what is not there yet ~ host/live/shown_layer.cpp ~ choose_tone(tone, whole, metadata) ~ choose_tone(tone, film, metadata) ~ [live]
meshes of domains one unit high ~ host/assets/placement.cpp ~ if (loaded.mesh) { // about ~ if (false) { // about ~ [periodic]
albedos of maps taken from 1 in single precision ~ host/fields/value_map.cpp ~ knot.absorbed = 1.0 - from.albedo; ~ knot.absorbed = 1.0f - glm::vec3(from.albedo); ~ [counted]
collisions decided by 24 bits ~ shaders/lib/rng.glsl ~ + float(words.z & 255u) * 0.00390625 ~ + 0.0 ~ [rng]
ratios of null collisions that round alike ~ shaders/estimators/transmittance/ratio_transmittance.glsl ~ T - T * (c.sigma_t / c.sigma_maj * c.ratio) ~ T * (1.0 - c.sigma_t / c.sigma_maj * c.ratio) ~ [closed_form]
variances of merged depths by one sample less ~ host/cli/merge.cpp ~ n / (n - 1.0) * squares[i] ~ squares[i] ~ [merge]
depths without their product by weights ~ shaders/film/aovs.glsl ~ add_product(sum, sum_low, x); ~ ; ~ [aovs]
files that changed between two moments ~ host/assets/input_files.cpp ~ !is_new && seen->second != stamp ~ false && seen->second != stamp ~ [motion]
textures of pbrt without their shifts ~ host/pbrt_files/pbrt_textures.cpp ~ * place + shift_of(*texture_) ~ * place ~ [pbrt]
coloured fog before surfaces without weight ~ shaders/stages/surface.glsl ~ lane.beta *= depth_weight(v, lane.beta, lane.walk.depth, false); ~ ; ~ [surfaces]
null collisions lit beyond the depth limit ~ shaders/stages/collide.glsl ~ NEE == NEE_TENTATIVE && lane.path.depth < frame.max_depth ~ NEE == NEE_TENTATIVE && lane.path.depth <= frame.max_depth ~ [image]
lamps of rough glass that light themselves ~ shaders/stages/collide.glsl ~ if (beyond > 0.0 && drawn.distance ~ if (beyond > 2.0 && drawn.distance ~ [surfaces]
splats without room for peaks of phase functions ~ host/device_scene/emitter_table.cpp ~ peak = std::max(peak, phase_peak( ~ peak = std::max(peak, 0.0 * phase_peak( ~ [particles]
flat domains without an extent ~ host/device_scene/period.cpp ~ static_cast<float>(low - margin) ^ static_cast<float>(high + margin) ~ static_cast<float>(low) ^ static_cast<float>(high) ~ [periodic]
room of splats for facets ~ host/device_scene/emitter_table.cpp ~ peak = std::max(peak, facet_peak(surface)); ~ (void)surface; ~ [particles]
scatter between parts by its coverage ~ host/cli/merge.cpp ~ n * (scatter + w * w) * apart ~ n * w * apart ~ [merge]
far balls weighed by the cosines of rounding ~ shaders/lights/families.glsl ~ vec2(0.5 / PI, 1.0 / light.area) ~ vec2(cosine / PI, 1.0 / light.area) ~ [particles]
ground lit by the sun alone ~ host/assets/daylight.cpp ~ irradiance += angle * direction.y * radiance; ~ ; ~ [xml]
sky's chromaticity by x alone ~ host/assets/daylight.cpp ~ zenith_[2] * ratio(y_) ~ zenith_[2] * ratio(x_) ~ [xml]
sunlight through no air ~ host/assets/daylight.cpp ~ 0.008735 * std::pow ~ 0.0 * std::pow ~ [xml]
sunlight through no ozone ~ host/assets/daylight.cpp ~ + 0.35 * ozone[c] ~ + 0.0 * ozone[c] ~ [xml]
depths of surfaces without the last flight ~ shaders/stages/surface.glsl ~ flown_before(lane) + lane.reach ~ flown_before(lane) ~ [aovs]
albedo layer of surfaces white ~ shaders/stages/surface.glsl ~ row.color); ~ vec3(1.0)); ~ [aovs]
a surface too many ~ shaders/stages/surface.glsl ~ lane.path.depth >= frame.max_depth ~ lane.path.depth > frame.max_depth ~ [surfaces]
roulette within glass without weight ~ shaders/stages/depart.glsl ~ goes_on ? 1.0 / chance : 0.0 ~ goes_on ? 1.0 : 0.0 ~ [surfaces]
error of sums of particles by one sample less ~ host/render/film_bands.cpp ~ variance += double(sum.count) * variance_of_mean(sum); ~ variance += (double(sum.count) - 1.0) * variance_of_mean(sum); ~ [particles]
sums of splats that carry nothing ~ shaders/film/splats.glsl ~ uint carried = add_word(into + 1u, add_word(into, low)); ~ uint carried = 0u; add_word(into, low); ~ [particles]
splats of absorption by the unit of length ~ host/device_scene/emitter_table.cpp ~ return scene.camera.edges.x * scene.camera.edges.y * scene.camera.edges.z; ~ return 1e-30 * scene.camera.edges.x; ~ [counted]
lamps in the planes of large surfaces hidden from looks ~ shaders/surfaces/nearest.glsl ~ return (reach - t) * abs(dot(at.normal, ray.direction)) <= 0.125 * at.apart; ~ return false; ~ [particles]
whatever is met near a light passed over ~ shaders/surfaces/nearest.glsl ~ <= 0.125 * at.apart; ~ <= 1.0e9 * at.apart; ~ [surfaces]
particles that begin within large surfaces ~ host/device_scene/emitter_table.cpp ~ : FlatPiece(p).spare_of(place, extent); ~ : 0.0; ~ [particles]
particles that begin within large balls ~ host/device_scene/emitter_table.cpp ~ ? spare_of_ball(p, place) ~ ? 0.0 ~ [particles]
glow of grids of another unit ~ host/device_scene/emitter_table.cpp ~ even + 0.1 * most; ~ even + channel_mean(emission.color); ~ [emission]
planes known by any of their points ~ host/device_scene/surface_table.cpp ~ foot = plane.normal * glm::dot(plane.normal, point); ~ foot = point; ~ [invariance]
textures of planes from where they are nearest ~ host/device_scene/surface_table.cpp ~ glm::fract(apart * surface_.material.repeat) ~ glm::fract(0.0 * apart) ~ [surfaces]
turned air as far as what rounding leaves reaches ~ host/device_scene/period.cpp ~ turned.transform = without_rounding(volume.transform); ~ ; ~ [periodic]
tables of more blocks than numbers count ~ host/fields/grid_tree.cpp ~ const double blocks = double(field_.leaf_dims.x) * field_.leaf_dims.y * field_.leaf_dims.z; ~ const double blocks = double(field_.leaf_dims.x * field_.leaf_dims.y * field_.leaf_dims.z); ~ [density]
files of OpenVDB 13 ~ host/fields/vdb_check.cpp ~ newest_version = 225 ~ newest_version = 224 ~ [density]
versions of files told to the library ~ host/fields/vdb_import.cpp ~ version = std::min(version, static_cast<std::uint32_t>(openvdb::OPENVDB_FILE_VERSION)); ~ version = std::max(version, 0u); ~ [density]
names of libraries with blanks ~ host/fields/obj_file.cpp ~ && word != "mtllib") ~ ) ~ [mesh]
checkpoints of other lanes ~ host/render/session_setup.cpp ~ name_by_bits(device.info().name) ~ device.info().name ~ [checkpoint]
media that end paths only together ~ host/assets/render_limits.cpp ~ lost += volume.density_scale ~ lost = volume.density_scale ~ [layers]
splats as fine whatever pixels see of a lamp ~ host/device_scene/emitter_table.cpp ~ if (!counts && method.paths == PATHS_LIGHT) ~ if (!counts && method.paths == PATHS_CAMERA) ~ [particles]
splats in units of one length ~ host/device_scene/emitter_table.cpp ~ return farthest > 0.0 ? farthest : 1.0; ~ return farthest > 0.0 ? 1.0 : 1.0; ~ [particles]
a shape of its own with what was for the other's ~ host/scene_files/scene_shape.cpp ~ return shape < scope_of(name); ~ return shape > scopes_.size(); ~ [several]
a layer of alpha taken for the picture's ~ host/image/image_io.cpp ~ film.is_premultiplied ? film.layer("alpha") : nullptr; ~ film.layer("alpha"); ~ [command]
a second signal of any kind ends at once ~ host/base/interrupt.cpp ~ if (signals_seen && signal == SIGINT) ~ if (signals_seen && signal != 0) ~ [command]
pictures through pipes not gone back in ~ host/base/atomic_file.cpp ~ std::copy_n(bytes, size, kept_.begin() + static_cast<std::ptrdiff_t>(at)); ~ std::copy_n(bytes, size, kept_.end() - static_cast<std::ptrdiff_t>(size)); ~ [command]
what a dead process left taken for another's ~ host/image/image_io.cpp ~ unlink(probe.c_str()); // of a process long dead, with our number ~ ; ~ [command]
absorbed power to as many digits as albedos have ~ host/device_scene/frame_params.cpp ~ params.absorbed = 1.0 - albedo_of(volume); ~ params.absorbed = 1.0f - params.albedo; ~ [counted]
far light from just above a sensor before the plane it lies in ~ host/device_scene/emitter_table.cpp ~ 2.0 * shift_of_sensor(scene, origin), 0x1p-20 * height}); ~ 0.0 * height}); ~ [counted]
far lights as coarse as all that they send out ~ host/device_scene/emitter_table.cpp ~ return light.kind & LIGHT_FLAT ? seen : 0.25 * seen; ~ return 1.0; ~ [particles]
folded polygons ~ host/fields/polygon.cpp ~ if (folds && corners.size() <= most_to_cut) ~ if (folds && corners.size() > most_to_cut) ~ [mesh]
readings surely black after a few paths ~ host/render/session.cpp ~ done_ * double(result_.film.pixel_count()) >= surely_black ~ done_ >= 1024 ~ [command]
nothing as an end of domains ~ host/device_scene/period.cpp ~ if (has_matter(scene.volumes[i], media[i])) ~ if (i < media.size()) ~ [periodic]
render space in the middle of the air ~ host/assets/superposition.cpp ~ box.low.x > box.high.x ? camera : 0.5 * (box.low + box.high); ~ camera + 100.0; ~ [several]
grids of one name not told apart ~ host/fields/nvdb_file.cpp ~ before > 0 || ~ false || ~ [density]
backgrounds counted as voxels ~ host/fields/grid_tree.cpp ~ field_.cleaned = before; ~ field_.cleaned = std::max(before, field_.cleaned); ~ [density]
kernels with sensors that they do not have ~ host/device_scene/kernel_constants.cpp ~ {SPEC_SENSOR, SENSOR_PINHOLE}, ~ {SPEC_PHASE, PHASE_HENYEY_GREENSTEIN}, ~ [specialization]
narrow peaks of moments between angles ~ host/assets/phase_table.cpp ~ if (moments > 1024) ~ if (moments > 1000000) ~ [phase]
lamps at what has no extent infinitely bright ~ host/device_scene/light_table.cpp ~ return distance > 0.0 ? distance * distance : 1.0; ~ return std::max(distance * distance, 1e-300); ~ [surfaces]
limits of comparisons one-sided ~ host/cli/compare.cpp ~ return normal_upper(0.5 * each); ~ return normal_upper(each); ~ [compare]
points within surfaces ~ host/assets/render_limits.cpp ~ surface.shape) <= SURFACE_SPARE) ~ surface.shape) < 0.0) ~ [xml]
lights whose disc is partly below as units ~ host/scene_files/scene_units.cpp ~ std::asin(mu0) < glm::radians(0.5 * sun->angle)) ~ mu0 < 0.0) ~ [xml]
black bodies brighter by what is clipped ~ host/fields/blackbody.cpp ~ shown * (xyz.y / luminance) : shown; ~ shown : shown; ~ [emission]
caustics of far light not told ~ host/methods/method_biases.cpp ~ if (is_thrown_from_afar()) ~ if (false) ~ [particles]
layers of a viewer by parts of names ~ host/cli/view.cpp ~ ("," + all + ",").find("," + wanted + ",") ~ all.find(wanted) ~ [live]
refused layers of a viewer stay ~ host/cli/view.cpp ~ if (all == wanted) ~ if (true) ~ [live]
keys that a viewer's camera takes away missed ~ host/cli/watched_scene.cpp ~ overrides.may_be_unused.insert(key); ~ (void)key; ~ [live]
sensors in the planes of surfaces ~ host/device_scene/sensor_params.cpp ~ params.position += shift_of_sensor(scene, origin) ~ params.position += 0.0 * shift_of_sensor(scene, origin) ~ [counted]
pieces of grids beyond their voxels ~ host/assets/superposition.cpp ~ glm::min(piece.middle + pieces.half, glm::dvec3(bounds.high)) ~ piece.middle + pieces.half ~ [layers]
cavities filled ~ host/fields/mesh.cpp ~ if ((body.volume < 0.0) != body.is_cavity) ~ if (body.volume < 0.0) ~ [mesh]
maps over their data alone ~ host/image/radiance_map.cpp ~ header.y - header.full_y + ~ header.full_height - header.height + ~ [xml][surfaces]
colours multiplied by alpha ~ host/codec/oiio_codec.cpp ~ as_stored.attribute("oiio:UnassociatedAlpha", 1); ~ ; ~ [xml][surfaces]
what readings lost not told ~ host/cli/measure.cpp ~ add_counts(told.counts, result.counts); ~ ; ~ [command]
sums weighted by the first pixel ~ host/cli/merge.cpp ~ *std::max_element(input.film.samples.begin(), input.film.samples.end()) ~ input.film.samples.front() ~ [merge]
pictures older than their samples passed over ~ host/cli/rendered_before.cpp ~ std::filesystem::last_write_time(output, error) < first ~ false ~ [command]
bubbles of glass as balls of it ~ host/pbrt_files/pbrt_surfaces.cpp ~ thing.type != "plymesh" && faces_inwards(shape) ~ thing.type != "plymesh" && false ~ [pbrt]
seams of quadrics open ~ host/pbrt_files/pbrt_quadrics.cpp ~ u == 1.0 && turn == 2.0 * pi ? 0.0 : u ~ u ~ [pbrt]
rims wider than a spot's cone ~ host/pbrt_files/pbrt_lights.cpp ~ falls = 2.0 * angle - falls; ~ falls = angle; ~ [pbrt]
depths up an exponential from its thin end ~ shaders/field/layers.glsl ~ return exp(f.log_density + (f.rate < 0.0 ? x : 0.0)) * t * mean; ~ return exp(f.log_density) * t * (f.rate < 0.0 ? (exp(x) - 1.0) / x : mean); ~ [layers]
distances up an exponential from what its thin end has ~ shaders/field/layers.glsl ~ if (f.rate < 0.0 && log_y > 0.0) ~ if (false) ~ [layers]
edges' products without numbers ~ shaders/surfaces/surface_point.glsl ~ return 1.0 / max(max(longest.x, longest.y), max(longest.z, 1.0e-30)); ~ return 1.0; ~ [surfaces]
rays begin at the eye for the sake of planes ~ host/device_scene/sensor_params.cpp ~ return plane && cuts_off( ~ return plane && !cuts_off( ~ [precision]
cosines at a panorama's poles by rounding ~ shaders/sensors/toward_sensor.glsl ~ max(level, 1.0e-12 * distance) ~ sqrt(max(1.0 - dot(ray, s.down) * dot(ray, s.down), 1.0e-12)) * distance ~ [particles]
what holds nothing has no end ~ host/assets/superposition.cpp ~ whole.unbounded = ~ whole.unbounded = any_medium(scene, is_everywhere) || ~ [several]
voxels of what holds nothing ~ host/device_scene/overlap_words.cpp ~ row.kinds.field == FIELD_GRID && row.kinds.shape != SHAPE_NONE ~ row.kinds.field == FIELD_GRID ~ [several]
colours of what holds nothing ~ host/device_scene/frame_params.cpp ~ is_chromatic && largest(sigma_t) > 0.0 ~ is_chromatic ~ [several]
maps in no checkpoint ~ host/render/checkpoint.cpp ~ digest.add_all(medium.map_knots); ~ ; ~ [checkpoint]
no far light where filters alone count it ~ host/device_scene/device_scene.cpp ~ beyond * (glm::length ~ 0.0 * beyond * (glm::length ~ [counted]
lamps not seen where nothing scatters ~ host/methods/method.cpp ~ has_steps ? NEE_TENTATIVE : NEE_COLLISIONS ~ has_steps ? NEE_TENTATIVE : NEE_NONE ~ [lights]
what mirrors throw and show taken for found ~ host/methods/method_biases.cpp ~ has_thrown_light() && method_.paths == PATHS_BOTH ~ false ~ [particles]
distances of looks toward what is far by rounding ~ shaders/lights/equiangular.glsl ~ if (s.mass.x + s.mass.y < 1.0e-5 * ~ if (s.mass.x + s.mass.y < 0.0 * ~ [lights]
kernels that hang on the frame alone ~ shaders/lib/buffers.glsl ~ return number + (gl_GlobalInvocationID.x >> 31u); ~ return number; ~ [command]
moments at the same times for all seeds ~ host/scene/motion_blur.cpp ~ + turn_of(seed); ~ + turn_of(0u * seed); ~ [motion]
moments that last twice as long ~ host/scene/motion_blur.cpp ~ together *= 2; ~ together *= 4; ~ [motion]
what moves as at its first moment ~ host/render/session.cpp ~ enter_moments(); ~ ; ~ [motion]
later moments not what identifies a render ~ host/render/session_setup.cpp ~ identity_.kernel += scene_hash(*moving_); ~ identity_.kernel += ""; ~ [motion]
frames of files not whole while something moves ~ host/scene_files/scene_keys.cpp ~ *number + (is_time ? time_ : 0.0); ~ *number; ~ [motion]
grids drift backwards ~ host/fields/drift.cpp ~ glm::dvec3(voxel) - way(voxel) ~ glm::dvec3(voxel) + way(voxel) ~ [motion]
what drifts into empty blocks lost ~ host/fields/drift.cpp ~ widen(axis, (reach_[axis] + 7) / 8); ~ widen(axis, 0); ~ [motion]
velocities cleaned as colours ~ host/fields/grid_tree.cpp ~ if (!field_.is_signed || ~ if (true || ~ [motion]
velocities on faces taken for middles ~ host/fields/drift.cpp ~ from[axis] += 0.5; ~ from[axis] += 0.0; ~ [motion]
panes of one side ~ shaders/surfaces/bsdf.glsl ~ u * (1.0 + F) < 2.0 * F ~ u < F ~ [surfaces]
pbrt's media on the sides where they are written ~ host/pbrt_files/pbrt_sides.cpp ~ return {shape.outside, shape.inside}; ~ return {shape.inside, shape.outside}; ~ [pbrt]
what an imported file sets stays ~ host/pbrt_files/pbrt_directives.cpp ~ tokens_.depth() <= imports_.back().files ~ tokens_.depth() == 0 ~ [pbrt]
colours of an Attribute in a later space ~ host/pbrt_files/pbrt_directives.cpp ~ parameters(tokens_, state_.color_space); ~ parameters(tokens_); ~ [pbrt]
colours of voxels taken for multiples of one ~ host/pbrt_files/pbrt_rgb_media.cpp ~ > 1e-6 * largest_of(each) ~ > 1e6 * largest_of(each) ~ [pbrt]
foreseen grids kept when their files change ~ host/fields/field_cache.cpp ~ coming.mapped().stamp == stamp ~ true ~ [density]
pixels that move together taken for independent ~ host/image/film.cpp ~ if (film.is_correlated) ~ if (false) ~ [motion]
black foretold of what moves ~ host/report/explain.cpp ~ if (authored.motion_blur) ~ if (false) ~ [motion]
frames whose time is over begun again ~ host/cli/render_command.cpp ~ (options.is_frame && !result.interrupted && !result.failure) ~ false ~ [command]
pictures that show otherwise taken for those asked for ~ host/cli/rendered_before.cpp ~ (shows(options) && !has_recorded ~ (false && !has_recorded ~ [command]
slow viewers waited for ~ host/live/tev_picture.cpp ~ Clock::now() - begun_ > limit ~ Clock::now() - begun_ > 10 * limit ~ [live]
first looks put off as all others are ~ host/render/session.cpp ~ (preview_seconds_ - preview_allowance) ~ (preview_seconds_ - 0.0) ~ [live]
wishes without a length read ~ host/live/view_server.cpp ~ if (!request.has_header("Transfer-Encoding")) ~ if (true) ~ [live]
viewers' keys not asked for ~ host/live/view_server.cpp ~ port) && has_key(request) ~ port) || has_key(request) ~ [live]
what is wrong with a viewed file forgotten ~ host/cli/view.cpp ~ rendered = render_wish(); ~ file_trouble_.clear(), rendered = render_wish(); ~ [live]
channels in tev one after another ~ host/live/tev_picture.cpp ~ packet.add(count); ~ packet.add(std::int64_t{1}); ~ [live]
radiances as parts without pi ~ host/scene_files/scene_units.cpp ~ : std::numbers::pi) ~ : 1.0) ~ [xml]
slopes of keys from one side ~ host/scene_files/keyed_values.cpp ~ i == 0 ? 0 : i - 1 ~ i ~ [xml]
particles counted in one domain alone ~ shaders/stages/count.glsl ~ position - frame.period.size * floor ~ position - 0.0 * floor ~ [counted]
particles not counted on their way into a domain ~ shaders/stages/seam.glsl ~ if (COUNTS_PASSING) ~ if (false) ~ [counted]
filters that end at a panorama's seam ~ shaders/sensors/toward_sensor.glsl ~ abs(to_pole) < reach ~ false ~ [particles]
pixels of particles taken for independent ~ host/render/session.cpp ~ moving_ || method_.paths != PATHS_CAMERA; ~ moving_.has_value(); ~ [particles]
files told apart by name and size alone ~ host/methods/scene_hash.cpp ~ digest_of_file(path) ~ std::string() ~ [xml][surfaces]
samples lost where a moment cannot be made ready ~ host/render/session.cpp ~ if (job_.checkpoint) ~ if (job_.checkpoint && device_scene_) ~ [motion]
depth of single samples merged as if exact ~ host/cli/merge.cpp ~ * apart * apart ~ * 0.0 * apart ~ [merge]
sums over pixels without a variance ~ host/cli/compare.cpp ~ if (is_correlated || std::max(a.samples[i], b.samples[i]) != 1) ~ if (true) ~ [compare]
splats without room for what is seen ~ host/device_scene/emitter_table.cpp ~ counts ? 0.0 : brightest_of( ~ counts ? 1e-30 : 0.0 * brightest_of( ~ [particles]
maps that glow without particles ~ host/device_scene/emitter_table.cpp ~ channel_mean(emission.constant) + channel_mean(most_map_emission(scene.volumes[i])) ~ channel_mean(emission.constant) ~ [particles]
places on textures not in the hash ~ host/methods/scene_hash.cpp ~ writer.add("place", glm::dvec3(places[corner], 0.0)); ~ (void)places; ~ [xml][surfaces]
frames that are exposed otherwise passed over ~ host/report/requested_scene.cpp ~ if (const auto& exposure = scene.camera.exposure) ~ if (const auto& exposure = scene.camera.exposure; false) ~ [command]
layers of other groups passed over ~ host/report/requested_scene.cpp ~ text += ", " + layers; ~ ; ~ [command]
channels of counted particles not weighted ~ shaders/stages/count.glsl ~ if (!collided && !NULL_FLIGHT) ~ if (false) ~ [counted]
what is cut off glows nevertheless ~ shaders/lights/emit.glsl ~ && !is_in_domain(p.position) ~ && false ~ [counted]
light aslant through a face as if straight ~ shaders/lights/emit.glsl ~ abs(rise) * light ~ light ~ [counted]
what is scattered counted as absorbed ~ shaders/stages/collide.glsl ~ vec3(lane.beta) * absorbed_at(met, lane.path.position), lane ~ vec3(lane.beta), lane ~ [counted]
cells upside down ~ shaders/stages/count.glsl ~ s.cells.y - 1 - cell.y + s.cells.y ~ cell.y + s.cells.y ~ [counted]
cells of a grid half a cell off ~ host/cli/reading_grid.cpp ~ camera.cell_low({0, 0, 0}) + 0.5 * camera.cell_size()} ~ camera.cell_low({0, 0, 0})} ~ [counted]
lights of particles not in the hash ~ host/methods/scene_hash.cpp ~ if (method.uses_lights() || ~ if (method.nee != NEE_NONE || ~ [counted]
flights that rest forgotten while surfaces are asked ~ shaders/stages/laid_aside.glsl ~ amid && (todo == TODO_SEEK || todo == TODO_CHECK) ~ amid && todo == TODO_SEEK ~ [determinism]
an exponential taken for even by shadow rays in parts ~ shaders/estimators/transmittance/analytic_transmittance.glsl ~ LAYERED ? faded_depth(fading_along(v, w.origin, w.direction), w.t_end) : w.t_end ~ w.t_end ~ [layers]
misses taken for certain where a domain repeats ~ shaders/passes/sky.comp ~ HAS_PARTICLES || REPEATS || ~ HAS_PARTICLES || ~ [periodic]
a domain a hundredth too large ~ host/device_scene/period.cpp ~ params.size = scene.periodic->size(); ~ params.size = 1.01 * scene.periodic->size(); ~ [periodic]
eyes beyond a domain stay there ~ shaders/shapes/period.glsl ~ return position - p.size * floor((position - p.low) / size); ~ return position; ~ [periodic]
surfaces of a domain met beyond its seams alone ~ shaders/stages/seam.glsl ~ looks ? FAR : reach_of_flight(lane) ~ FAR ~ [periodic]
depths begin anew in each domain ~ shaders/stages/collide.glsl ~ flown_before(lane) + lane.walk.start ~ lane.walk.start ~ [periodic]
optical depth drawn anew in each domain ~ shaders/stages/seek.glsl ~ REPEATS && lane.seams != 0u ~ false ~ [periodic]
no shadow pass where a domain repeats ~ host/device_scene/kernel_constants.cpp ~ constants[SPEC_PERIODIC] != 0 || (form ~ (form ~ [periodic]
keys all of their first value ~ host/cli/measure.cpp ~ = values[i]; ~ = options.sweeps[i].values.front(); ~ [command]
map taken from the knot before ~ shaders/field/value_map.glsl ~ .value <= value ? next ~ .value <= 0.9 * value ? next ~ [value_map]
map bounded at the ends of values alone ~ host/fields/value_map.cpp ~ if (point.value >= low && point.value <= high) ~ if (false) ~ [value_map]
map bounded by the largest value alone ~ host/fields/majorant_grid.cpp ~ mapped_range(map, least, most) ~ mapped_range(map, most, most) ~ [value_map]
mapped values by a stochastic corner ~ host/methods/method.cpp ~ linear_shadows && !has_map(scene_); ~ linear_shadows; ~ [value_map]
mapped albedo left out ~ shaders/field/albedo.glsl ~ albedo *= mapped_albedo(v, mapped_value(v, position)); ~ ; ~ [value_map]
mapped emission left out ~ shaders/field/emission.glsl ~ radiance += mapped_emission(v, mapped_value(v, position)); ~ ; ~ [value_map]
map's table of another medium ~ host/device_scene/frame_params.cpp ~ params.first_knot = layout.first_knot(loaded); ~ params.first_knot = 0; ~ [value_map]
air that thins half as fast ~ shaders/field/layers.glsl ~ exp(-v.layers.decay * height) ~ exp(-0.5 * v.layers.decay * height) ~ [layers]
layers of a box above them counted from its bottom ~ host/device_scene/frame_params.cpp ~ params.above = static_cast<float>(box.low[layers.axis] - layers.bottom); ~ ; ~ [layers]
layers bounded by their upper face ~ host/fields/layers.cpp ~ layer_density(volume, from) * (1.0 + rounding)} ~ layer_density(volume, to) * (1.0 + rounding)} ~ [layers]
cells of what is everywhere end ~ shaders/majorants/majorant.glsl ~ vec3(FAR), outward(v, w, block)) ~ t_face, outward(v, w, block)) ~ [layers]
albedo + 2 % ~ host/device_scene/frame_params.cpp ~ params.albedo = albedo_of(volume); ~ params.albedo = 1.02 * albedo_of(volume); ~ [image]
g sign in sampling ~ shaders/phase/phase.glsl ~ hg_sample(v.phase.g, ~ hg_sample(-v.phase.g, ~ [image]
g sign toward the light ~ shaders/phase/phase.glsl ~ hg_eval(v.phase.g, hg_from_peak(v.phase.g, ~ hg_eval(-v.phase.g, hg_from_peak(-v.phase.g, ~ [image]
light direction reversed in phase ~ shaders/lights/directional.glsl ~ direction, light.direction) ~ direction, -light.direction) ~ [image]
Draine drawn in too few steps ~ shaders/phase/draine.glsl ~ i < 10 ~ i < 3 ~ [phase]~[agreement]
phase functions of two swapped ~ shaders/phase/double_henyey_greenstein.glsl ~ second ? p.g2 : p.g, ~ second ? p.g : p.g2, ~ [phase]~[agreement]
droplets drawn without alpha ~ shaders/phase/droplets.glsl ~ second ? p.alpha : 0.0 ~ 0.0 ~ [phase]~[agreement]
tables drawn as if level ~ shaders/phase/phase_table.glsl ~ 2.0 * slope * share ~ slope * share ~ [phase]~[agreement]
1 / 4 pi missing ~ shaders/phase/henyey_greenstein.glsl ~ return INV_4PI * (1.0 - a) ~ return (1.0 - a) ~ [image]
majorant x 0.9 ~ host/fields/majorant_grid.cpp ~ bound = std::max(bound, value); ~ bound = std::max(bound, 0.9f * value); ~ [image]
majorant not dilated ~ host/fields/majorant_grid.cpp ~ glm::max((first - 1) / grid.cell, glm::ivec3(0)); ~ high; ~ [image]
lookup half a voxel off ~ shaders/estimators/ahead.glsl ~ vec3 p = w.origin + t[k] * w.direction; ~ vec3 p = w.origin + t[k] * w.direction + 0.5; ~ [image]
roulette weight missing ~ shaders/stages/depart.glsl ~ threshold / m : 0.0 ~ 1.0 : 0.0 ~ [image]
shadow roulette weight missing ~ shaders/estimators/transmittance.glsl ~ SHADOW_ROULETTE / m : 0.0 ~ 1.0 : 0.0 ~ [image]
last cell left out ~ shaders/majorants/majorant.glsl ~ inside != next; ~ inside != next || next + (next - w.cell) != clamp(next + (next - w.cell), ivec3(0), v.cell_dims - 1); ~ [image]
leap a cell too far ~ host/fields/empty_space.cpp ~ std::max<std::uint8_t>(nearest, 1) - 1; ~ nearest; ~ [majorant]
leap beyond the point at its end ~ shaders/majorants/majorant.glsl ~ next = clamp(there, ~ next = clamp(there + side, ~ [majorant]
sessions that begin again with their first seed ~ host/render/session.cpp ~ device_scene_->set_seed(job_.seed); ~ ; ~ [determinism]
sessions that begin again on their old film ~ host/render/session.cpp ~         clear(commands_, band); ~         (void)band; ~ [determinism]
sessions that begin again where they were stopped ~ host/render/session.cpp ~ pixels_ = std::nullopt; ~ ; ~ [determinism]
outermost cells that hold what ends ~ host/assets/superposition.cpp ~ has_ring ? 1 : 0 ~ has_ring ? 0 : 0 ~ [cpu][layers]
rows left on the device that had them ~ host/render/session_devices.cpp ~ {from.commands_, from.bands_[band], from.film_layers_} ~ {to.commands_, to.bands_[band], from.film_layers_} ~ [devices]
layers of moved rows among the records ~ host/render/film_bands.cpp ~ record_bytes(to.layers) + first ~ first ~ [devices]
what other devices left over forgotten ~ host/render/session_devices.cpp ~ pixels_->insert(pixels_->end(), left.begin(), left.end()); ~ ; ~ [devices]
pixels left over given to several devices ~ host/render/session_devices.cpp ~ pixel >= rows.begin * width() && pixel ~ pixel ~ [devices]
paths of other devices not counted ~ host/render/session_devices.cpp ~ add_counts(result_.counts, counts); ~ add_counts(result_.counts, RenderCounts{}); ~ [devices]
later moments on the first device alone ~ host/render/session_devices.cpp ~ follower->session->enter_moment(); ~ ; ~ [devices]
film variance / n for / (n - 1) ~ host/render/film_bands.cpp ~ / (n - 1.0) ~ / n ~ [determinism]
voxel length inverted ~ host/assets/loaded_medium.cpp ~ sigma_t / field->voxel_size() ~ sigma_t * field->voxel_size() ~ [invariance]
surfaces scatter without cosine ~ shaders/surfaces/bsdf.glsl ~ b.color * (cosine / PI) : ~ b.color / PI : ~ [surfaces]
glass reflects one polarisation ~ shaders/surfaces/fresnel.glsl ~ 0.5 * (parallel * parallel + across * across) ~ (parallel * parallel) ~ [surfaces]
radiance the same within glass ~ shaders/surfaces/bsdf.glsl ~ reflects ? b.color : b.color / (eta * eta) ~ b.color ~ [surfaces]
metals take glass's index ~ shaders/surfaces/bsdf.glsl ~ fresnel_conductor(cosine, b.eta, b.k) ~ vec3(fresnel_dielectric(cosine, b.eta.x)) ~ [surfaces]
surfaces throw no shadow ~ shaders/stages/seek.glsl ~ if (over && looks && lane.seek.primitive != NO_SURFACE) ~ if (over && looks && lane.seek.primitive == 0u) ~ [surfaces]
flights collide behind surfaces ~ shaders/stages/lane.glsl ~ return lane.reach; ~ return FAR; ~ [surfaces]
mirrors show no lamps ~ shaders/stages/depart.glsl ~ bool sees = is_shown && seen.distance < FAR; ~ bool sees = false; ~ [surfaces]
the sky twice on surfaces ~ shaders/stages/depart.glsl ~ lane.phase_pdf = drawn.pdf; ~ lane.phase_pdf = 0.0; ~ [surfaces]
lamps seen through bodies ~ shaders/surfaces/nearest.glsl ~ p.surface != body ? meet ~ body == NO_SURFACE ? meet ~ [surfaces]
lamps drawn among those that are hidden ~ shaders/lights/lamp.glsl ~ if ((t < hidden || i == front) && bright > 0.0) { ~ if (i != front) { ~ [surfaces]
lamps and their surfaces both shine ~ host/methods/surface_lamps.cpp ~ scene.surfaces[i].emission = Rgb(0.0); ~ ; ~ [surfaces]
lamps of surfaces with one side ~ host/methods/surface_lamps.cpp ~ (side > 0.0 || surface.shines_both_ways) ~ side > 0.0 ~ [surfaces]
points on surfaces weighed as collisions are ~ shaders/stages/collide.glsl ~ if (LOOKS_ALONG && !is_surface(s)) ~ if (LOOKS_ALONG) ~ [surfaces]
looks from along what lies behind surfaces ~ shaders/lights/equiangular.glsl ~ s.t.y = max(min(s.t.y, reach), s.t.x); ~ ; ~ [surfaces]
no looks from along flights that surfaces end ~ shaders/stages/seek.glsl ~ goes_to_look = look_along(v, lane, rng, tally); ~ ; ~ [surfaces]
a render that stops at twice its noise ~ host/render/session.cpp ~ *noise <= *job_.noise_goal ~ *noise <= 2.0 * *job_.noise_goal ~ [determinism]
noise looked at whenever a batch is done ~ host/render/session.cpp ~ std::min({next_, wanted_ - done_, until_next_check(), until_next_moment()}) ~ std::min(next_, wanted_ - done_) ~ [determinism]
a picture of other samples taken for this one ~ host/cli/rendered_before.cpp ~ text_of(metadata, "vkvol/asked") == asked_text(options, scene) ~ true ~ [command]
an interrupted picture taken for a whole one ~ host/cli/rendered_before.cpp ~ text_of(metadata, "vkvol/interrupted") == "0" ~ true ~ [command]
pbrt's usual glow even ~ host/pbrt_files/pbrt_dense_media.cpp ~ glm::abs((at + 0.5) / glm::dvec3(dims) - 0.5) ~ 0.0 * at ~ [pbrt]
black bodies without Le's scale ~ host/pbrt_files/pbrt_dense_media.cpp ~ float(scale) * glm::vec3(glm::mix ~ glm::vec3(glm::mix ~ [pbrt]
quadrics inside out ~ host/pbrt_files/pbrt_quadrics.cpp ~ return Point{radius * outward, outward}; ~ return Point{radius * outward, -outward}; ~ [pbrt]
stretched spheres taken for round ones ~ host/pbrt_files/pbrt_quadrics.cpp ~ 0.5 * stretch_of_digits ~ 1e9 * stretch_of_digits ~ [pbrt]
an observer of other wavelengths ~ host/fields/blackbody.cpp ~ (here + next) ~ (here + here) ~ [emission]
flights counted from where light begins ~ shaders/lights/equiangular.glsl ~ max(t - s.first, 0.0) ~ max(t - s.t.x, 0.0) ~ [lights]
a spot's cone the wrong way ~ shaders/lights/equiangular.glsl ~ square > 0.0 && b > 0.0 ? ~ square > 0.0 && b < 0.0 ? ~ [lights]
pbrt's voxels at their corners ~ host/pbrt_files/pbrt_voxels.cpp ~ bounds.low + 0.5 * voxel ~ bounds.low ~ [pbrt]
pbrt's clouds of another noise ~ host/pbrt_files/pbrt_cloud.cpp ~ h < 4 || h == 12 || h == 13 ~ h < 4 || h == 12 || h == 14 ~ [pbrt]
grids in memory known by their names alone ~ host/fields/field_cache.cpp ~ return {0, {}, file.memory}; ~ return {}; ~ [pbrt]
lamps of surfaces not looked for by default ~ host/methods/integrators.cpp ~ scene.lights.empty() && !has_lamps_of_surfaces(scene); ~ scene.lights.empty(); ~ [method]
pbrt's world left-handed ~ host/pbrt_files/pbrt_translator.cpp ~ world_[2][2] = mirrors ? -1.0 : 1.0; ~ ; ~ [pbrt]
pbrt's sky on its side ~ host/pbrt_files/pbrt_translator.cpp ~ const glm::dmat3 upright(1, 0, 0, 0, 0, 1, 0, 1, 0); ~ const glm::dmat3 upright(1.0); ~ [pbrt]
pbrt's maps never mirrored ~ host/assets/sky_map.cpp ~ if (light.mirror) ~ if (false) ~ [pbrt]
roughness of pbrt's facets as it is ~ host/pbrt_files/pbrt_surfaces.cpp ~ u = std::sqrt(std::max(u, 0.0)); ~ ; ~ [pbrt]
fronts of reversed triangles in front ~ host/pbrt_files/pbrt_triangles.cpp ~ ? mirrors != is_reversed ~ ? mirrors && is_reversed ~ [pbrt]
fronts away from normals ~ host/pbrt_files/pbrt_triangles.cpp ~ mesh.normals[t.z]) < 0.0 ~ mesh.normals[t.z]) > 0.0 ~ [pbrt]
loops written out against the plea ~ host/vulkan/specialization.cpp ~ spirv[i + 3] == unroll) ~ spirv[i + 3] == dont_unroll) ~ [specialization]
kernels shared whatever their constants ~ host/vulkan/pipelines.cpp ~ declared_of(spirv, specialization)} ~ Specialization{}} ~ [specialization]
rows of lights one texel off ~ shaders/lights/row.glsl ~ LIGHT_ROW_TEXELS * i + which ~ LIGHT_ROW_TEXELS * i ~ [lights]
textures upside down ~ shaders/surfaces/texture.glsl ~ vec2(within.x, 1.0 - within.y) ~ within ~ [surfaces]
texels half a texel off ~ shaders/surfaces/texture.glsl ~ * vec2(size) - 0.5; ~ * vec2(size); ~ [surfaces]
boards that run into each other ~ shaders/surfaces/texture.glsl ~ if (header.x < 0.0) ~ if (false) ~ [surfaces]
maps as bright as they say whatever illuminance ~ host/pbrt_files/pbrt_lights.cpp ~ illuminance / own_illuminance(light) ~ illuminance / std::max(own_illuminance(light), pi) ~ [pbrt]
squares of a board as large as two ~ host/pbrt_files/pbrt_textures.cpp ~ add_repeat(attributes, texture, 0.5) ~ add_repeat(attributes, texture, 1.0) ~ [pbrt]
textures where the sky's texels are ~ host/device_scene/device_scene.cpp ~ assets.sky ? static_cast<std::uint32_t>(assets.sky->texels.size()) : 0 ~ 0 ~ [surfaces]
normals taken for places on a texture ~ shaders/surfaces/surface_point.glsl ~ details = primitive_at(details.surface); ~ ; ~ [surfaces]
particles keep radiance behind glass ~ shaders/surfaces/bsdf.glsl ~ float factor = crosses ? b.eta.x * b.eta.x : 1.0; ~ float factor = 1.0; ~ [particles]
particles seen without the slope of rays ~ shaders/sensors/toward_sensor.glsl ~ weight = 1.0 / (dot(ray, s.forward) * abs( ~ weight = 1.0 / (abs( ~ [particles]
particles of a point shine into half of space ~ shaders/lights/emit.glsl ~ in_any_direction(u), 4.0 * PI * light.radiance ~ in_any_direction(u), 2.0 * PI * light.radiance ~ [particles]
particles of weak lights end as those of strong ones ~ shaders/stages/depart.glsl ~ HAS_PARTICLES ? lane.begun_with : 1.0 ~ 1.0 ~ [particles]
particles see the normal that light sees ~ shaders/stages/depart.glsl ~ has_drawn_as_seen(bsdf, drawn.direction) ? draws : 0.0 ~ draws ~ [particles]
particles without the chance of their source ~ shaders/lights/emit.glsl ~ p.light /= source.chance * frame.particles.power; ~ p.light /= frame.particles.power; ~ [particles]
splats that carry nothing ~ shaders/film/splats.glsl ~ high += before + low < before ? 1u : 0u; ~ ; ~ [particles]
paths keep what particles bring too ~ shaders/lights/families.glsl ~ return sensor_share > 0.0 ? 1.0 / (1.0 + sensor_share * light_share) : 1.0; ~ return 1.0; ~ [particles]
a filter's density twice ~ shaders/sensors/toward_sensor.glsl ~ (1.0 - x / count) / (count * between) ~ 2.0 * (1.0 - x / count) / (count * between) ~ [particles]
a cut batch is collected ~ host/render/session.cpp ~ if (over) { ~ if (true) { ~ [particles]
facets seen from above alone ~ shaders/surfaces/microsurface.glsl ~ float z = 1.0 - u.x * (1.0 + stretched.z); ~ float z = 1.0 - u.x; ~ [surfaces]
what was lower stays so behind facets ~ shaders/surfaces/microsurface.glsl ~ walk.c = crosses ? 1.0 - walk.c : walk.c; ~ ; ~ [surfaces]
radiance the same behind facets ~ shaders/surfaces/microsurface.glsl ~ weight = walk.side < 0.0 ? walk.weight / (f.eta.x * f.eta.x) : walk.weight; ~ weight = walk.weight; ~ [surfaces]
facets that hide no light ~ shaders/surfaces/microsurface.glsl ~ value += walk.weight * leaving_chance(to, walk.c, f.alpha) * ~ value += walk.weight * ~ [surfaces]
light goes once through a coat ~ shaders/surfaces/bsdf.glsl ~ passes / (b.eta * b.eta * (1.0 - b.color * b.k.x)) ~ passes / (b.eta * b.eta) ~ [surfaces]
faces flat that stand for something smooth ~ shaders/surfaces/surface_point.glsl ~ return has_normals && ~ return false && ~ [surfaces]
light goes through between faces ~ shaders/surfaces/bsdf.glsl ~ drawn.weight *= is_barred(b, wo, drawn.direction) ? 0.0 : 1.0; ~ ; ~ [surfaces]
bytes of a .ply file in one order ~ host/fields/ply_file.cpp ~ if (format_ == Format::big_endian) ~ if (false) ~ [mesh]
normals moved as directions are ~ host/assets/surface_mesh.cpp ~ glm::transpose(glm::inverse(glm::dmat3(transform))) ~ glm::dmat3(transform) ~ [mesh]
surfaces shine backwards ~ shaders/stages/surface.glsl ~ dot(normal, travel) < 0.0 ~ dot(normal, travel) > 0.0 ~ [surfaces]
no ray starts off its surface ~ shaders/surfaces/surface_point.glsl ~ at.apart = spare_at ~ at.apart = -spare_at ~ [surfaces]
camera rows flipped ~ host/assets/camera_rays.cpp ~ dy = -2.0 * s ^ dx, s + picture.start_y ~ dy = 2.0 * s ^ dx, -s + picture.start_y ~ [image]
nearest lookup truncates ~ shaders/field/density.glsl ~ floor(p + 0.5) ~ floor(p) ~ [image]
stochastic corner reversed ~ shaders/field/density.glsl ~ lessThan(tap, p - base) ~ greaterThan(tap, p - base) ~ [density]
depth limit off by one ~ shaders/stages/collide.glsl ~ lane.path.depth >= frame.max_depth ~ lane.path.depth > frame.max_depth ~ [image]
emission without its albedo ~ host/device_scene/frame_params.cpp ~ params.constant = absorbed * ~ params.constant = ~ [image]
all samples the same ~ shaders/lib/rng.glsl ~ rng.sample_index, rng.draw ~ 0u, rng.draw ~ [image]
spectral weight missing ~ shaders/estimators/flight/spectral_flight.glsl ~ max(P, 1.0e-30) ~ 1.0 ~ [agreement]
weighted flight without sign ~ shaders/estimators/flight/weighted_flight.glsl ~ sign(sigma_n) ~ 1.0 ~ [free_flight]
channels not weighted ~ shaders/estimators/channel.glsl ~ density * total(abs(beta)) / mean ~ vec3(1.0) ~ [agreement]
cubic through wrong values ~ shaders/field/voxels.glsl ~ -5.5 * f[0] + 9.0 * f[1] ~ -5.5 * f[0] + 8.9 * f[1] ~ [free_flight]
colours over alpha after their curve ~ host/image/tone_map.cpp ~ display_value(color_of(i), mapping.curve, white) ~ clamped(display_value(exposed(film.mean[i], gain), mapping.curve, white) / a) ~ [aovs]
smooth across indices alone ~ host/assets/surface_mesh.cpp ~ sum += glm::dot(sums[*other], own) > 0.0 ? sums[*other] : glm::dvec3(0.0) ~ sum += *other == vertex ? own : glm::dvec3(0.0) ~ [mesh]
grids without a name ~ host/fields/vdb_check.cpp ~ !plain.empty() && seen.insert(plain).second ~ seen.insert(plain).second ~ [density]
files of moments ~ host/scene_files/scene_keys.cpp ~ if (!are_numbers(text)) ~ if (are_numbers("x")) ~ [motion]
colours by the order of channels ~ host/image/radiance_map.cpp ~ ending == ".exr" ? ~ false ? ~ [image_io]
panes of glass turned by rounding ~ host/pbrt_files/pbrt_sides.cpp ~ if (as_rectangle(mesh)) ~ if (false) ~ [pbrt]
depths of merged pictures by samples alone ~ host/cli/merge.cpp ~ coverage ? coverage->mean[i].x * n : 0.0 ~ coverage ? 1.0 * n : 0.0 ~ [merge]
telescoping by the difference of two sums ~ shaders/estimators/transmittance/telescoping_transmittance.glsl ~ == 0u ? -sampled : sampled ^ Spectrum of_lesser = exp(-sigma_t * min(w.depth, w.depth - w.partial)) ^ Spectrum size = of_lesser * one_minus_exp(sigma_t * abs(w.partial)) ^ w.partial > 0.0 ? -size : size ~ == 0u ? 2.0 * sampled : 0.0 ^ Spectrum of_lesser = exp(-sigma_t * w.partial) ^ Spectrum size = exp(-sigma_t * w.depth) - of_lesser ^ size ~ [transmittance]
numbers of rows 256 apart the same ~ shaders/lib/rng.glsl ~ (words >> 16u) ~ uvec4(0u) ~ [rng]
noise looked at after 16 samples of few pixels ~ host/render/session.cpp ~ 4.0 / (*job_.noise_goal * pixels) ~ 0.0 ~ [determinism]
errors of particles' sums from a resume on ~ host/render/session.cpp ~ write_sums(commands_, bands_, width(), from.sums); ~ ; ~ [particles]
few samples judged as many ~ host/cli/compare.cpp ~ normal_of_t(z_of(sums.tested_a[c], sums.tested_b[c], variance.variance), variance.freedom()) ~ z_of(sums.tested_a[c], sums.tested_b[c], variance.variance) ~ [merge]
telescoping with wrong chances ~ shaders/estimators/transmittance/telescoping_transmittance.glsl ~ (1.0 - exp(TELESCOPING_LOG_Q)) * ~ 1.2 * (1.0 - exp(TELESCOPING_LOG_Q)) * ~ [transmittance]
control density not seen ~ shaders/estimators/transmittance/residual_transmittance.glsl ~ T *= exp(-c.sigma_c * c.flown * c.ratio); ~ ; ~ [transmittance]
null collisions lit in full ~ shaders/estimators/free_flight.glsl ~ : c.sigma_t / c.sigma_maj; ~ : 1.0; ~ [agreement]
march without albedo ~ shaders/stages/collide.glsl ~ deposit * to_spectrum(albedo_at(met, position)), ~ deposit, ~ [agreement]
known light not added ~ shaders/stages/collide.glsl ~ add_light(lane, lit * lane.cached * light, label); ~ ; ~ [light_cache]
cache of one direction only ~ host/device_scene/light_cache.cpp ~ push.towards = directions_[i]; ~ push.towards = directions_[0]; ~ [light_cache]
rays begin at far eyes ~ host/device_scene/sensor_params.cpp ~ !(depth > 16.0 * radius) ~ true ~ [precision]
far indices stay far ~ host/assets/placement.cpp ~ longest(middle) < std::max(4096, 4 * size) ~ longest(middle) >= -size ~ [precision]
faces a millionth too far ~ shaders/majorants/majorant.glsl ~ return max(w.t, min( ~ return max(w.t, 1.000001 * min( ~ [precision]
thin media at 24 bits ~ shaders/lib/rng.glsl ~ word < small ? series ~ false ? series ~ [rng]
window some words off ~ shaders/field/grid.glsl ~ frame_block.grid_windows[i >> WINDOW_BITS] ~ frame_block.grid_windows[(i + 64u) >> WINDOW_BITS] ~ [windows]
pixels lost at a checkpoint ~ host/render/wavefront.cpp ~ first * sizeof(std::uint32_t)); ~ 0 * first); ~ [checkpoint]
fingerprint without grids ~ host/render/checkpoint.cpp ~ add(grid->bytes.span()); ~ ; ~ [checkpoint]
huge samples kept ~ shaders/film/film.glsl ~ 281474976710656.0 ~ 3.0e38 ~ [command]
steps ahead of a collision kept ~ shaders/estimators/ahead.glsl ~ walk.t = t[k]; ~ walk.t = w.t; ~ steps found ahead*
numbers for steps ahead not put back ~ shaders/estimators/ahead.glsl ~ rng.draw += 1u; ~ rng.draw = ahead.draw; ~ steps found ahead*
a step ahead judged by the next density ~ shaders/estimators/ahead.glsl ~ Collision(sigma_t[k], ~ Collision(sigma_t[(k + 1) % STEPS], ~ steps found ahead*
roulette in closed form ~ shaders/estimators/flight/analytic_flight.glsl ~ w.t = event == ~ beta = march_roulette(0.0, beta);\n    w.t = event == ~ [closed_form]
march roulette weight missing ~ shaders/estimators/march.glsl ~ MARCH_ROULETTE / m : 0.0 ~ 1.0 : 0.0 ~ [closed_form]
cache corrected without its chance ~ shaders/stages/shadow.glsl ~ (T - lane.cached) / lane.chance ~ (T - lane.cached) ~ [light_cache]
foreseen light off its mean ~ shaders/phase/phase.glsl ~ hg_eval(v.phase.g * v.phase.g, ~ hg_eval(v.phase.g, ~ [agreement]
lattice a node off ~ shaders/lights/lattice.glsl ~ uint i = lattice_index(which, node); ~ uint i = lattice_index(which, node) + 1u; ~ [light_cache]
no further part of a mesh ~ shaders/shapes/segment.glsl ~ event == EVENT_LEFT && search.stage == SEARCH_OVER; ~ false; ~ [closed_form]
a flight stays in its part after a shadow ray ~ shaders/stages/shadow.glsl ~ lane.search.stage = SEARCH_OVER; ~ ; ~ flights go on to the next body*
a search laid aside forgets its crossings ~ shaders/shared/path_state.h ~ ROW(PartSearch, search, has_parts) ~ ROW(PartSearch, search, false) ~ [closed_form]
octaves lost to a driver's loops ~ host/render/plan.cpp ~ const std::uint32_t octaves = loops.octaves > 0 ? loops.octaves + 1 : 0; ~ const std::uint32_t octaves = 0; ~ [determinism]
irradiance without its cosine ~ shaders/sensors/flux.glsl ~ max(dot(direction, frame.sensors[0].corner), 0.0) / PI ~ 0.25 / PI ~ [flux]
fluence by a half of all directions ~ shaders/lib/directions.glsl ~ turned(vec3(0.0, 1.0, 0.0), 2.0 * u.x, ~ turned(vec3(0.0, 1.0, 0.0), u.x, ~ [flux]
a sensor's rays and looks both in full ~ shaders/stages/depart.glsl ~ READS_FLUX ? flux_pdf(lane.path.direction) : 0.0 ~ 0.0 ~ [flux]
rows of points mixed up ~ shaders/sensors/camera.glsl ~ (place >> 16u) * camera.row ~ (place >> 16u) ~ [flux]
light scattered twice counted as once ~ shaders/film/aovs.glsl ~ scatterings == 1u ? SCATTERED_ONCE ~ scatterings <= 2u ? SCATTERED_ONCE ~ [aovs]
a look's label without its group ~ shaders/stages/collide.glsl ~ label |= group_label(row.group); ~ ; ~ [aovs]
a path's first medium forgotten ~ shaders/shared/path_state.h ~ ROW(uint, first_label, has_layers) ~ ROW(uint, first_label, false) ~ [aovs]
depth of all channels by the first ~ shaders/stages/collide.glsl ~ t[c] = mean_part(sigma[c] * w.t_end) * w.t_end; ~ t[c] = mean_part(sigma[0] * w.t_end) * w.t_end; ~ [aovs]
depth in an atmosphere without what is behind ~ shaders/stages/collide.glsl ~ u * one_minus_exp(sigma[c] * whole) ~ u ~ [aovs]
depth from where rays begin ~ shaders/film/aovs.glsl ~ s.start > 0.0 ? ~ false ? ~ [aovs]
layers lost at a checkpoint ~ host/render/session.cpp ~ film_layers_, from.layers); ~ device_scene_->frame().layers, std::vector<glm::vec3>(from.layers.size())); ~ [aovs]
depths merged without their weights ~ host/cli/merge.cpp ~ coverage->mean[i].x * n ~ 1.0 ~ [merge]
an output over an input by a link ~ host/scene_files/file_uses.cpp ~ if (is_same_file(output.file, input.file)) ~ if (output.file == input.file) ~ no output is an input or another output
a checkpoint written over ~ host/cli/checkpoint_file.cpp ~ if (!options_.resume && is_checkpoint(path_)) ~ if (false) ~ [checkpoint]
azimuth clockwise ~ host/scene/camera_view.cpp ~ camera.yaw = orbit.azimuth; ~ camera.yaw = -orbit.azimuth; ~ [xml]
noise against no signal ~ host/image/film.cpp ~ signal += glm::dot(mean, mean); ~ signal += 1.0; ~ [film]
crop forgotten in random numbers ~ shaders/sensors/camera.glsl ~ frame.crop_x + pixel ~ pixel ~ [determinism]
staged samples out of order ~ shaders/passes/accumulate.comp ~ film_or_splats(sums, radiance, pixel, where, push.sample_begin + at.added, tally); ~ if (at.added != 1u) film_or_splats(sums, radiance, pixel, where, push.sample_begin + at.added, tally); ~ [determinism]
a place taken before it is free ~ shaders/passes/generate.comp ~ tenants != index / push.places) { ~ tenants > 99999u) { ~ the sizes of the machine*
staged shadow rays leave flights at rest ~ shaders/shared/path_state.h ~ ROW(Walk, flight, flight_rests) ~ ROW(Walk, flight, false) ~ [agreement]
a cached transmittance forgotten between passes ~ shaders/shared/path_state.h ~ ROW(Spectrum, cached, has_cache) ~ ROW(Spectrum, cached, false) ~ [light_cache]
rayleigh drawn as it is not ~ shaders/phase/rayleigh.glsl ~ float w = (4.0 * u - 2.0) / share; ~ float w = (4.2 * u - 2.1) / share; ~ [phase]
shadow rays past their lamp ~ shaders/shapes/segment.glsl ~ return LIGHTS == LIGHTS_LONE ? t : min(t, reach); ~ return t; ~ [lights]
weights of looks and flights off ~ shaders/lights/table.glsl ~ own > 0.0 ? 1.0 / (1.0 + (MIS ~ own > 0.0 ? 1.0 / (0.9 + (MIS ~ [lights]
sky drawn without its sine ~ shaders/lights/sky.glsl ~ / max(breadth, 1.0e-12)); ~ ); ~ [lights]
sky turned the other way ~ shaders/lights/equirectangular.glsl ~ + 0.5 + sky.turn) ~ + 0.5 - sky.turn) ~ [lights]
sun's disc too wide ~ shaders/lights/disc.glsl ~ return 2.0 * INV_4PI / light.extent; ~ return 1.9 * INV_4PI / light.extent; ~ [lights]
sun brighter for its dark limb ~ host/scene/lights.cpp ~ (1.0 - sun.limb_darkening / 3.0) ~ (1.0 - sun.limb_darkening / 2.0) ~ [lights]
limb dark to looks alone ~ shaders/lights/table.glsl ~ ? disc_radiance(light, place) : ~ ? light.radiance : ~ [lights]
square map's edges not the other way around ~ shaders/lights/equal_area.glsl ~ ivec2(inside.x, last - texel.y) ~ inside ~ [lights]
square map turned over ~ shaders/lights/equal_area.glsl ~ float cosine = below ? r * r - 1.0 : ~ float cosine = below ? 1.0 - r * r : ~ [lights]
searches in phase functions not counted ~ host/render/plan.cpp ~ return iterations + loops.phase + loops.lights + records; ~ return iterations + loops.lights + records; ~ [determinism]
lamp without its cosine ~ shaders/lights/flat.glsl ~ (light.area * max(-dot(direction, light.direction), 1.0e-12)) ~ light.area ~ [lights]
lamps not drawn by the phase function ~ shaders/lights/lamp.glsl ~ bool by_phase = select < share; ~ bool by_phase = false; ~ [lights]
one lamp for all that are seen ~ shaders/lights/lamp.glsl ~ seen.light *= met > 0.0 ? 2.0 / (1.0 / met + own / sum) : 0.0; ~ ; ~ [lights]
tree's chance forgotten ~ shaders/lights/table.glsl ~ chance *= of_leaf; ~ ; ~ [lights]
branch's chance not its own ~ shaders/lights/tree.glsl ~ float(goes_left ? share : 0u - share) ~ float(share) ~ [lights]
cones of lamps seen from one point of their box ~ shaders/lights/tree.glsl ~ less_angle(seen, angle_of(sqrt(1.0 - half_square / square))) ~ seen ~ [lights]
cones of lamps without the spread of their axes ~ host/device_scene/light_tree.cpp ~ static_cast<float>(std::cos(spread)) ~ 1.0f ~ [lights]
collisions near a light in full ~ shaders/lights/equiangular.glsl ~ flown / max(flown + equiangular_pdf(s, t), 1.0e-30) ~ 1.0 ~ [lights]
distances drawn otherwise than stated ~ shaders/lights/equiangular.glsl ~ float m = u * ~ float m = u * u * ~ [lights]
way to where a look from along a flight begins not attenuated ~ shaders/stages/shadow.glsl ~ lane.lit *= T; ~ ; ~ [lights]
density of a direction forgotten in a queue ~ shaders/shared/path_state.h ~ ROW(float, phase_pdf, sees_sky) ~ ROW(float, phase_pdf, false) ~ [lights]
a look laid aside like a vertex ~ shaders/stages/laid_aside.glsl ~ return looks || sets_out_again(todo) ? LOOK_ROWS : VERTEX_ROWS; ~ return VERTEX_ROWS; ~ [agreement]
the last words of a path not copied ~ shaders/stages/laid_aside.glsl ~ PATH_WORD(slot, i + 3u) = copied[i + 3u]; ~ PATH_WORD(slot, i + 3u) = copied[i]; ~ [layout]
words of all media's cells as long as one's ~ shaders/stages/laid_aside.glsl ~ uint words_of(ivec3 x) { return 3u; } ~ uint words_of(ivec3 x) { return 0u; } ~ [determinism]
spot without its rim ~ shaders/lights/point.glsl ~ t * t * (3.0 - 2.0 * t) ~ t ~ [lights]
albedos end with the grid's box ~ shaders/field/albedo.glsl ~ index = clamp(index, vec3(a.grid.voxel_min), vec3(a.grid.voxel_max)); ~ ; ~ [color_grids]
albedos above 1 ~ shaders/field/albedo.glsl ~ min(lookup_color(a.grid, KIND(ALBEDO_TYPE, v, albedo_type), index), vec3(1.0)) ~ lookup_color(a.grid, KIND(ALBEDO_TYPE, v, albedo_type), index) ~ [color_grids]
glow without the grid's albedo ~ shaders/field/emission.glsl ~ radiance *= absorbed_at(v, position); ~ ; ~ [color_grids]
colours a word off in a leaf ~ shaders/field/density.glsl ~ LEAF_COLORS = 32u ~ LEAF_COLORS = 33u ~ [color_grids]
a third grid at the second's place ~ host/device_scene/upload_layout.cpp ~ next.first_word += static_cast ~ next.first_word = static_cast ~ [color_grids]
media drawn evenly, not by their shares ~ shaders/field/superposition.glsl ~ bool drawn = u < share; ~ bool drawn = u < 0.5 && sigma_t > 0.0 || share == 1.0; ~ [several]
extinctions do not add up ~ shaders/field/superposition.glsl ~ found.density += sigma_t; ~ found.density = max(found.density, sigma_t); ~ [several]
shares of channels missing ~ shaders/estimators/free_flight.glsl ~ beta *= c.share; ~ ; ~ [several]
every path scatters by the first medium ~ shaders/stages/depart.glsl ~ medium_of(v, lane.path.medium) ~ medium_of(v, 0u) ~ [several]
looks scatter by the first medium ~ shaders/stages/shadow.glsl ~ medium_of(v, lit_medium(lane)) ~ medium_of(v, 0u) ~ [several]
parts of a medium bounded too small ~ host/assets/superposition.cpp ~ around(map, 0.5 * (from + to), 0.5 * (to - from)); ~ around(map, piece.middle, 0.5 * pieces.half); ~ [several]
second table of a kind at the first's place ~ host/device_scene/upload_layout.cpp ~ size += static_cast<std::uint32_t>(table.size()); ~ ; ~ [several]
second grid at the first's place ~ host/device_scene/upload_layout.cpp ~ next.first_word += ~ next.first_word += 0 * ~ [several]
grids of members mixed up ~ host/device_scene/overlap_words.cpp ~ member.grid = found->second; ~ member.grid = texels * rows.size(); ~ [several]
cells of bricks transposed ~ shaders/majorants/cells.glsl ~ cell_index(cell & ((1 << CELL_BITS) - 1), ~ cell_index(cell.zyx & ((1 << CELL_BITS) - 1), ~ [several]
coarse cells as short as fine ones ~ shaders/majorants/majorant.glsl ~ block = CellBlock((w.cell & -w.cell_edge) ~ block = CellBlock(w.cell ~ [several]
bricks bounded by one medium ~ host/assets/superposition.cpp ~ std::nextafter(bounds[entry] + bound, ~ std::max(bounds[entry], 0.0f * std::numeric_limits<float>::max() + bound); (void)std::nextafter(bound, ~ [several]
reach of a brick's cells too far ~ host/assets/superposition.cpp ~ -float(std::min<int>(reaches[i], margin)) ~ -float(std::min<int>(reaches[i] + 1, margin)) ~ [several]
a shared array written in place ~ host/fields/shared_array.h ~ values_.use_count() > 1 ~ values_.use_count() > 9 ~ [density]
temperatures stay where the file has them ~ host/fields/density_field.h ~ index_to_world = transform * as_authored; ~ index_to_world = as_authored; ~ [several]
lamps before a mesh seen through it ~ shaders/shapes/segment.glsl ~ t.x = min(t.x, t.y); // the first ~ // the first ~ [lights]
walls in seams left there ~ host/device_scene/device_scene.cpp ~ kept_off_seams(*scene.periodic, origin_, scene.surfaces) ~ scene.surfaces ~ [periodic]
faces in seams without their neighbours ~ host/device_scene/seams.cpp ~ moves[t.x] = moves[t.y] = moves[t.z] = true; ~ (void)0; ~ [periodic]
ends of far particles as flights know them ~ shaders/stages/count.glsl ~ if (event == EVENT_LEFT && t < FAR && t == lane.reach) ~ if (false) ~ [counted]
models of other colours with the same hash ~ host/methods/scene_hash.cpp ~ add_materials(writer, scene.volumes); ~ (void)0; ~ [method]
readings that no file takes lost ~ host/cli/measure.cpp ~ put(stdout, as_csv(rows)); ~ (void)0; ~ [command]
readings written at the end alone ~ host/cli/measure.cpp ~ options.output && !is_special(*options.output); // from ~ false; // from ~ [command]
no report of what no method renders ~ host/report/report.cpp ~ = hash_if_rendered(scene); ~ = scene_hash(scene); ~ [command]
one link of several followed ~ host/base/atomic_file.cpp ~ i < most && ~ i < 1 && ~ [image_io]
checkpoints of old versions called none ~ host/render/checkpoint.cpp ~ "another version of vkvol wrote it" ~ "it is none" ~ [checkpoint]
numbers amid text never small ~ host/base/number_text.cpp ~ && is_small({begin, result.ptr}) ~ && false ~ [xml]
lines of no area taken for rectangles ~ host/pbrt_files/pbrt_triangles.cpp ~ glm::length(u) * glm::length(v) > 0.0 ~ size > 0.0 ~ [pbrt]
instances of any number of triangles ~ host/pbrt_files/pbrt_directives.cpp ~ if (triangles > most_triangles) ~ if (false) ~ [pbrt]
grids about a camera no medium of its scene ~ host/pbrt_files/pbrt_media.cpp ~ if (is_grid(scene_.camera_medium)) ~ if (false) ~ [pbrt]
exposures advised beside the camera's ~ host/report/explain_causes.cpp ~ mapping.curve) - camera; ~ mapping.curve) - 0.0 * camera; ~ [explain]
white of what is not divided by alpha yet ~ host/image/tone_map.cpp ~ std::max(white, brightest_channel(color_of(i))) ~ std::max(white, brightest_channel(exposed(film.mean[i], gain))) ~ [image_io]
glow beside what is too cold black ~ host/fields/blackbody.cpp ~ reference > 0.0 && blackbody_xyz(kelvin).y > 0.0 ~ false ~ [emission]
emission without effect in units ~ host/scene_files/scene_medium.cpp ~ return is_grid ? emission : TemperatureEmission(); ~ return emission; ~ [xml]
values of a viewed grid from before ~ host/cli/view.cpp ~ // Grids that stand in it, or that it names, may be others. ~ if (false) ~ [live]
END
}

check_texts() {
    python3 -c '
import sys
missing = 0
for line in sys.stdin:
    name, path, texts = line.split(" ~ ")[:3]
    try:
        content = open(path).read()
    except OSError:
        content = ""
    for text in texts.split(" ^ "):
        if text not in content:
            missing += 1
            print(f"{name}: {path} does not contain \"{text}\"; bring the table in tools/mutation_check.sh up to date")
sys.exit(missing > 0)'
}
source=$root
stale() { # rows that are not of now, those that have no line at all first
    mutations | awk -F ' ~ ' -v word="$only" 'index($1, word)' | python3 "$source/tools/mutation_keys.py" "$source" "$results"
}

if [ -n "$dry_run" ]; then
    cd "$root"
    mutations | check_texts
    echo "$(mutations | wc -l) errors, of which $(stale | wc -l) were not made since something that they rest on changed"
    exit
fi

# Changed files only, with a new time, so that what was built of an earlier error is built again.
refresh_copy() {
    mkdir -p "$copy"
    local file
    while IFS= read -r -d '' file; do
        if [ -L "$root/$file" ]; then # to a folder, as it may be
            mkdir -p "$copy/$(dirname "$file")"
            ln -sfn "$(readlink "$root/$file")" "$copy/$file"
            continue
        fi
        [ -f "$root/$file" ] || continue
        cmp -s "$root/$file" "$copy/$file" && continue
        mkdir -p "$copy/$(dirname "$file")"
        cp "$root/$file" "$copy/$file"
    done < <(git -C "$root" ls-files -z --cached --others --exclude-standard)
    (cd "$copy" && find . -type f -print0) | while IFS= read -r -d '' file; do
        [ -f "$root/$file" ] || rm "$copy/$file"
    done
}

# replace FILE TEXT REPLACEMENT: all places; fails if there is none.
replace() {
    python3 - "$@" <<'END'
import sys
path, texts, replacements = sys.argv[1:]
content = open(path).read()
for text, replacement in zip(texts.split(" ^ "), replacements.split(" ^ "), strict=True):
    if text not in content:
        sys.exit(f"{path}: no longer contains \"{text}\"; bring the table up to date")
    content = content.replace(text, replacement.replace("\\n", "\n"))
open(path, "w").write(content)
END
}

build_tests() {
    cmake --build "$build" --target vkvol_tests </dev/null >"$work/build.log" 2>&1 || {
        tail -30 "$work/build.log" >&2
        echo "the copy does not build: $work/build.log" >&2
        return 1
    }
}

run_tests() { # SPECIFICATION: 0 if they pass
    (cd "$build" && timeout 600 ./vkvol_tests "$1" --abort -w NoTests </dev/null >"$work/tests.log" 2>&1)
}

# The first test that failed: Catch2's console reporter puts its name between two lines of dashes.
first_failure() {
    grep -q "FAILED:" "$work/tests.log" || return 1
    awk '/^------/ { if (named) named = 0; else { getline; name = $0; named = 1 } } /FAILED:/ { print name; exit }' \
        "$work/tests.log"
}

# A specification of one test; long names were cut off.
as_specification() { # NAME
    sed 's/[][,\\"*]/\\&/g; s/.$/&*/' <<<"$1"
}

# The test that caught an error the last time: that one is asked first. Nothing if there is none.
last_caught_by() { # NAME
    as_specification "$(awk -F ' *[|] *' -v name="$1" '$1 == name && $2 !~ /^(NOTHING|NOT |NO TEST)/ { print $2 }' "$results")"
}

# One row's verdict: the test that caught it, or, in capitals, why none did.
try_error() { # NAME FILE TEXT REPLACEMENT TESTS
    local verdict caught
    caught=$(last_caught_by "$1")
    cp "$copy/$2" "$work/original"
    if ! replace "$copy/$2" "$3" "$4"; then
        verdict="NOT MADE"
    elif ! build_tests; then
        verdict="NOT BUILT"
    elif [ -n "$caught" ] && ! run_tests "$caught" && verdict=$(first_failure); then
        : # nothing else need be asked
    elif run_tests "$5" && VKVOL_THOROUGH=1 run_tests "$5"; then # of long lists of cases the first has a part
        verdict="NOTHING: $5 passed"
    else
        verdict=$(first_failure) || verdict="NO TEST: the program failed, $work/tests.log"
    fi
    cp "$work/original" "$copy/$2"
    echo "$verdict"
}

# In the order of the table; lines of errors that are no longer made go. One run at a time writes.
keep() { # NAME VERDICT KEY
    local line name fresh=$work/results lock
    exec {lock}<"$results"
    flock "$lock"
    {
        echo "Each error alone, in a copy of the sources of that commit; what it rests on has the key: tools/mutation_check.sh."
        echo
        while IFS= read -r line; do
            name=${line%% ~ *}
            if [ "$name" = "$1" ]; then
                printf '%-56s | %-90s | %s | %s\n' "$name" "$2" "$commit" "$3"
            else
                awk -F ' *[|] *' -v name="$name" '$1 == name' "$results"
            fi
        done < <(mutations)
    } >"$fresh"
    cp "$fresh" "$results"
    exec {lock}<&-
}

mkdir -p "$work"
touch "$results" "$work/sound"
git -C "$root" rev-parse >/dev/null
mutations | cut -d'~' -f1 | grep -F -- "$only" >/dev/null || { echo "no error's name contains '$only'" >&2; exit 1; }
refresh_copy
source=$copy # which stays as it is while rows are made
mapfile -t selected < <(stale | awk -v first="${share%/*}" -v of="${share#*/}" 'NR % of == first % of')
[ ${#selected[@]} -gt 0 ] || { echo "every such error was caught, and nothing that it rests on has changed since"; exit; }
changed=$(git -C "$root" status --porcelain -- CMakeLists.txt host scenes shaders tests tools/make_field | wc -l)
commit=$(git -C "$root" rev-parse --short HEAD)$([ "$changed" = 0 ] || echo "+")
# An error may leave something unused, which is no error of its own.
cmake -S "$copy" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DVKVOL_UNITY=OFF \
    -DCMAKE_CXX_FLAGS="-Wno-unused-parameter -Wno-unused-variable -Wno-unused-function" >"$work/build.log"

# Whether a test fails by itself is asked once of a commit.
check_sound() { # NAME
    ! grep -qxF "$commit $1" "$work/sound" || return 0
    build_tests
    if ! run_tests "$(as_specification "$1")"; then
        tail -30 "$work/tests.log" >&2
        echo "'$1' fails without any error made: $work/tests.log" >&2
        exit 1
    fi
    [[ "$commit" == *+ ]] || echo "$commit $1" >>"$work/sound"
}

bad=0
made=0
for line in "${selected[@]}"; do
    [ $((SECONDS / 60)) -lt "$minutes" ] || break
    IFS=$tab read -r name file text replacement tests <<<"${line// ~ /$tab}"
    verdict=$(try_error "$name" "$file" "$text" "$replacement" "$tests")
    # A test that would fail anyway has caught nothing; a build and its tests are dear, so that is asked of failures alone.
    case $verdict in
    NO[T\ ]*) ;;
    *) check_sound "$verdict" ;;
    esac
    keep "$name" "$verdict" "$(python3 "$source/tools/mutation_keys.py" "$source" --key "$line" "$verdict")"
    printf '%-56s %s\n' "$name" "$verdict"
    made=$((made + 1))
    [[ "$verdict" != NO[T\ ]* ]] || bad=1
done
echo "$made errors made, $((${#selected[@]} - made)) left; $results"
exit $bad
