"""Cloth prints as small PNGs that repeat. Colours are given linear and stored as sRGB."""
from cloth import Noise
from linear import mix
import png


def srgb(linear):
    value = 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055
    return min(max(round(255 * value), 0), 255)


def picture(size, colour):
    """`colour(x, y)` → linear rgb at a pixel."""
    data = bytearray()
    for y in range(size):
        for x in range(size):
            data.extend(srgb(channel) for channel in colour(x, y))
    return png.encode(size, size, bytes(data))


def thread_noise(size, pitch, strength, seed):
    """A factor per thread (`pitch` pixels wide) and direction, so that a weave looks spun and not printed."""
    noise = Noise(seed)
    return [1 + strength * noise.signed() for _ in range(size // pitch)]


def weave(size, pitch, warp, weft, strength=0.10, seed=1):
    """Plain weave: `warp(t)` and `weft(t)` give the colour of the thread at t (0…1 of the tile) along x and along y."""
    across, along = thread_noise(size, pitch, strength, seed), thread_noise(size, pitch, strength, seed + 1)
    warps = [tuple(c * across[i] for c in warp((i + 0.5) / len(across))) for i in range(len(across))]
    wefts = [tuple(c * along[i] for c in weft((i + 0.5) / len(along))) for i in range(len(along))]
    # A thread is darker toward its sides, where it dives below the other.
    shade = [1.06 - 0.2 * abs((i + 0.5) / pitch - 0.5) * 2 for i in range(pitch)]

    def colour(x, y):
        i, j = x // pitch, y // pitch
        over = (i + j) % 2 == 0
        light = shade[x % pitch] * (1.0 if over else shade[y % pitch] / shade[x % pitch])
        return tuple(c * light for c in (warps[i] if over else wefts[j]))

    return picture(size, colour)


def gingham(size, checks, light, dark, pitch=4, seed=1):
    """`checks` pairs of light and dark stripes both ways; where they cross, the weave mixes them."""
    def stripe(t):
        return dark if t * checks % 1 < 0.5 else light
    return weave(size, pitch, stripe, stripe, seed=seed)


def plain(size, colour, pitch=4, strength=0.10, seed=1):
    return weave(size, pitch, lambda t: colour, lambda t: colour, strength, seed)


def stripes(size, count, first, second, share=0.5, pitch=4, seed=1):
    """Stripes along y: `share` of each period is the first colour."""
    return weave(size, pitch, lambda t: first if t * count % 1 < share else second,
                 lambda t: mix(second, first, share), seed=seed)


def stitched(size, colour, thread, seed=1):
    """A plain band with two rows of stitches along x, near the tile's edges in y."""
    noise = thread_noise(size, 2, 0.1, seed)

    def at(x, y):
        v, u = y / size, x / size * 4 % 1
        near = min(abs(v - 0.25), abs(v - 0.75)) < 0.05 and 0.15 < u < 0.8
        base = thread if near else colour
        return tuple(c * noise[x // 2] * noise[y // 2] for c in base)

    return picture(size, at)
