#!/usr/bin/env python3
"""images.py SLIPFIT [--each 30] [--seed 1]: images of surfaces without a pattern, read through slipfit-image: none may get a spacing with an interval below 10 %.

Random surfaces (white, smooth, scratched along one axis at random places), as PNG with a pixel grid (every pixel enlarged 2 to 12 times; every
other column set off) and as JPEG of several qualities and sizes, whose blocks of 8 or 16 pixels show. Beside them ridges of a known
spacing in JPEG of the same qualities, which have to be found. Needs Pillow."""
import pathlib
import random
import tempfile

from PIL import Image, ImageFilter

from evaluate import CONTROLS, control_row, parser, print_table, run, spacing_um

SIZES = ((160, 80), (400, 120), (900, 90))
QUALITIES = (10, 30, 60, 90)


def surface(rng, size, spacing=0.0):
    """Grey values: white noise, smoothed by some pixels or not, grooves, ridges of this spacing with white noise."""
    width, height = size
    tilt = rng.uniform(0, 0.05)
    grooves = [rng.gauss(0, rng.choice((0, 10))) for _ in range(width + height)]
    rows = bytes(int(min(255, max(0, rng.gauss(128, 25) + grooves[int(x + tilt * y)] + (60 * (x / spacing % 1) - 30 if spacing else 0))))
                 for y in range(height) for x in range(width))
    image = Image.frombytes("L", size, rows)
    radius = rng.choice((0, 0.7, 1.5, 3, 6))
    return image if spacing or not radius else image.filter(ImageFilter.GaussianBlur(radius))


def enlarged(rng, folder):
    times = rng.choice((2, 3, 4, 6, 8, 12))
    size = rng.choice(SIZES)
    small = surface(rng, (max(20, size[0] // times), max(10, size[1] // times)))
    small.resize((small.width * times, small.height * times), Image.NEAREST).save(folder / "image.png")
    return "image.png"


def odd_even(rng, folder):
    image = surface(rng, rng.choice(SIZES))
    shift = rng.randint(5, 40)
    rows = bytes(min(255, v + shift * (i % image.width % 2)) for i, v in enumerate(image.tobytes()))
    Image.frombytes("L", image.size, rows).save(folder / "image.png")
    return "image.png"


def jpeg(rng, folder, colours, spacing=0.0):
    image = surface(rng, rng.choice(SIZES), spacing)
    image.convert(colours).save(folder / "image.jpg", quality=rng.choice(QUALITIES))
    return "image.jpg"


FAMILIES = {"enlarged pixels": enlarged, "odd and even columns": odd_even, "JPEG, grey": lambda rng, folder: jpeg(rng, folder, "L"),
            "JPEG, colours": lambda rng, folder: jpeg(rng, folder, "RGB")}


def spacing_px(program, file):
    return spacing_um(run(program, "surface", file, "--pixel", "1um"))


def main():
    words = parser(__doc__)
    words.add_argument("program")
    words.add_argument("--each", type=int, default=30)
    words.add_argument("--seed", type=int, default=1)
    given = words.parse_args()
    groups, ridged = {family: [] for family in FAMILIES}, [0, 0, 0]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for family, make in FAMILIES.items():
            for i in range(given.each):
                file = folder / make(random.Random(f"{given.seed} {family} {i}"), folder)
                groups[family].append(control_row(spacing_px(given.program, file)))
        for i in range(given.each):
            rng = random.Random(f"{given.seed} ridges {i}")
            spacing = rng.uniform(18, 30)
            found = spacing_px(given.program, folder / jpeg(rng, folder, "L", spacing))
            ridged[0] += found is not None
            ridged[1] += found is not None and found[1] <= spacing <= found[2]
            ridged[2] += found is not None and abs(found[0] / spacing - 1) < 0.02
    print_table(CONTROLS, groups, "images without a pattern", whole=None)
    print(f"\nridges in JPEG: {ridged[0]} of {given.each} answered, {ridged[1]} of them in the interval, {ridged[2]} within 2 %")


if __name__ == "__main__":
    main()
