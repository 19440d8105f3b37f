"""What the recipes of tools/figures work with.

A recipe is a file tools/recipes/NAME.py: its first line says what it shows, MAKES lists the files that it leaves in
docs/figures, MEASURES (if it is there and true) says that it measures times, LONG that --quick leaves it out, TESTS names the
test programs it runs, NEEDS an environment variable it cannot do without, and make(kit) makes them. Whatever goes through
the kit is written down in NAME.sh beside them.
"""
import csv
import importlib
import itertools
import json
import os
import pathlib
import platform
import resource
import shlex
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


class Recipe:
    def __init__(self, name):
        module = importlib.import_module('recipes.' + name)
        self.name, self.make, self.makes = name, module.make, module.MAKES
        self.about = module.__doc__.strip().splitlines()[0].rstrip('.')
        self.measures = getattr(module, 'MEASURES', False)
        self.long, self.tests, self.needs = getattr(module, 'LONG', False), getattr(module, 'TESTS', []), getattr(module, 'NEEDS', None)


def load_recipes():
    """All of them, those that measure last: what they find is the machine's, and they take longest."""
    names = sorted(p.stem for p in (ROOT / 'tools/recipes').glob('*.py') if p.stem != 'kit')
    return sorted((Recipe(name) for name in names), key=lambda recipe: recipe.measures)


def program_folder():
    return pathlib.Path(os.environ.get('PLISSE_BUILD', ROOT / 'build/release')).resolve()


def table_mark(name, which):
    return f'<!-- table {name} {which}: made by tools/figures -->'


def markdown(header, rows):
    lines = ['| ' + ' | '.join(header) + ' |', '|' + '---|' * len(header)]
    lines += ['| ' + ' | '.join(str(cell) for cell in row) + ' |' for row in rows]
    return '\n'.join(lines)


def machine():
    """The day and the machine, in a sentence."""
    processor = next((line.split(':', 1)[1].strip() for line in open('/proc/cpuinfo') if line.startswith('model name')),
                     platform.machine())
    commit = subprocess.run(['git', 'describe', '--always', '--dirty'], cwd=ROOT, stdout=subprocess.PIPE, text=True).stdout.strip()
    return (f'{time.strftime("%Y-%m-%d")}, {processor}, {os.cpu_count()} threads of hardware, load {os.getloadavg()[0]:.1f} '
            f'when it began, commit {commit}.')


def cloth_look(camera='elevation = 18', ground=True):
    """A scene's tables behind [model]: plain cloth in raking light, which shows what waves there are."""
    return f'''[camera]
{camera}
focal_length = 85
[light]
key_azimuth = -65
key_elevation = 25
shadows = true
[shading]
colour = "#c9a66b"
roughness = 0.45
''' + ('[output]\nground = true\n' if ground else '')


def read_base(file):
    """What plisse drape wrote: vertices (x, y, z, held) and faces, each three vertices and its rest triangle, (u₀, v₀, … v₂)."""
    head, _, body = file.read_bytes().partition(b'end_header\n')
    counts = [int(line.split()[2]) for line in head.decode().splitlines() if line.startswith('element')]
    vertices = [struct.unpack_from('<dddB', body, 25 * i) for i in range(counts[0])]
    faces = [struct.unpack_from('<B3iB6d', body, 25 * counts[0] + 62 * i) for i in range(counts[1])]
    return vertices, [(face[1:4], face[5:]) for face in faces]


def read_png(data):
    """The rows of a PNG of 8-bit RGB or RGBA, three bytes a pixel."""
    chunks, at = {}, 8
    while at < len(data):
        size, kind = int.from_bytes(data[at:at + 4], 'big'), data[at + 4:at + 8]
        chunks[kind] = chunks.get(kind, b'') + data[at + 8:at + 8 + size]
        at += 12 + size
    width, height, depth, colour, _, _, interlace = struct.unpack('>IIBBBBB', chunks[b'IHDR'])
    if depth != 8 or colour not in (2, 6) or interlace:
        sys.exit('tools/figures: a PNG of another kind than 8-bit RGB or RGBA')
    n = 3 if colour == 2 else 4
    raw, stride, before, rows = zlib.decompress(chunks[b'IDAT']), n * width, bytes(n * width), []
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride if kind else 0):
            a, b, c = (line[i - n] if i >= n else 0), before[i], (before[i - n] if i >= n else 0)
            p = a + b - c
            nearest = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            line[i] = (line[i] + (0, a, b, (a + b) // 2, nearest)[kind]) & 255
        before = bytes(line)
        rows.append(before if n == 3 else b''.join(before[i:i + 3] for i in range(0, stride, 4)))
    return rows


def write_png(rows):
    """The PNG of rows of RGB."""
    def chunk(kind, body):
        return struct.pack('>I', len(body)) + kind + body + struct.pack('>I', zlib.crc32(kind + body))
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', len(rows[0]) // 3, len(rows), 8, 2, 0, 0, 0)) +
            chunk(b'IDAT', zlib.compress(b''.join(b'\0' + bytes(row) for row in rows), 9)) + chunk(b'IEND', b''))


def halved(rows):
    """At half the size, each pixel the mean of four."""
    out = []
    for up, down in zip(rows[::2], rows[1::2]):
        line = bytearray()
        for x in range(0, len(up) - 5, 6):
            for c in range(x, x + 3):
                line.append((up[c] + up[c + 3] + down[c] + down[c + 3] + 2) // 4)
        out.append(bytes(line))
    return out


class Kit:
    """Runs one recipe in a scratch folder, `self.work`; used with `with`."""

    def __init__(self, recipe, folder, size, pages, quick, program):
        self.recipe, self.folder, self.size, self.pages, self.quick, self.program = recipe, folder, size, pages, quick, program
        self.script, self.kept, self.began = [], [], machine()

    def __enter__(self):
        self.scratch = tempfile.TemporaryDirectory(prefix='plisse_figures_')
        self.work = pathlib.Path(self.scratch.name)
        # So that commands read the same in the scratch folder as in a clone.
        for name in ('assets', 'tools'):
            (self.work / name).symlink_to(ROOT / name)
        self.folder.mkdir(parents=True, exist_ok=True)
        return self

    def __exit__(self, *_):
        self.scratch.cleanup()

    # --- what recipes call; paths are below the scratch folder, where assets/ and tools/ are as in a clone

    def write(self, name, text):
        """A file of the recipe's own."""
        (self.work / name).write_text(text)
        self.script.append(f"cat > {name} << 'END'\n{text.rstrip()}\nEND")

    def plisse(self, *arguments, codes=(0,)):
        """Runs plisse and returns its --json report; self.spent: (seconds by the clock, CPU seconds of all its threads and
        children). `codes`: exit codes that are fine."""
        words = [str(a) for a in arguments]
        self.script.append('plisse ' + ' '.join(shlex.quote(word) for word in words))
        report = self.work / 'report.json'
        report.unlink(missing_ok=True)
        # What an earlier run solved would be found, and its time with it.
        environment = dict(os.environ, PLISSE_CACHE='none')
        before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        done = subprocess.run([self.program, *words, '-q', '--json', report], cwd=self.work, env=environment,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.spent = (time.monotonic() - began, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
        if done.returncode not in codes:
            sys.exit(f'tools/figures {self.recipe.name}: {self.script[-1]}\nended with {done.returncode}:\n{done.stdout[-3000:]}')
        return json.loads(report.read_text()) if report.exists() else {}

    def run(self, *command):
        """Runs another program, of tools/ say, and returns what it printed."""
        words = [str(word) for word in command]
        self.script.append(' '.join(shlex.quote(word) for word in words))
        done = subprocess.run(words, cwd=self.work, stdout=subprocess.PIPE, text=True)
        if done.returncode != 0:
            sys.exit(f'tools/figures {self.recipe.name}: {self.script[-1]}\nended with {done.returncode}')
        return done.stdout

    def test(self, name, filter):
        """Runs tests of the build, none of which may be skipped, and returns what they printed."""
        words = [f'tests/test_{name}', f'--gtest_filter={filter}']
        self.script.append(' '.join(shlex.quote(word) for word in words))
        done = subprocess.run([program_folder() / words[0], words[1]], stdout=subprocess.PIPE, text=True)
        if done.returncode != 0 or '[  SKIPPED ]' in done.stdout:
            sys.exit(f'tools/figures {self.recipe.name}: {self.script[-1]}\nended with {done.returncode}:\n{done.stdout[-3000:]}')
        return done.stdout

    def folder_of(self, variable, name):
        """The folder that an environment variable names, under this name here."""
        (self.work / name).symlink_to(pathlib.Path(os.environ[variable]).resolve())
        self.script.append(f'ln -s "${variable}" {name}')

    def expect(self, holds, otherwise):
        """Ends the run where what was made cannot be right."""
        if not holds:
            sys.exit(f'tools/figures {self.recipe.name}: {otherwise}')

    def frame(self, scene, picture, number=1, *options):
        """One frame of a scene as docs/figures/PICTURE."""
        self.plisse('render', scene, '-o', picture, '--frames', number, '--size', self.size, *options)
        self.keep(picture)

    def keep(self, file, name=None):
        """A file that was made, into docs/figures, under its own or another name."""
        name = name or pathlib.Path(file).name
        if name not in self.recipe.makes:
            sys.exit(f'tools/recipes/{self.recipe.name}.py: MAKES lacks {name}')
        shutil.copyfile(self.work / file, self.folder / name)
        self.kept.append(name)
        if pathlib.Path(file).name != name:
            self.script.append(f'cp {shlex.quote(str(file))} {shlex.quote(name)}')

    def keep_small(self, picture, name):
        """A PNG at half its size, into docs/figures."""
        (self.work / name).write_bytes(write_png(halved(read_png((self.work / picture).read_bytes()))))
        self.script.append(f'# {name}: {picture} at half its size')
        self.keep(name)

    def keep_sheet(self, lines, name):
        """Pictures of one size at half of it, lines of them side by side, into docs/figures."""
        rows = []
        for line in lines:
            pictures = [halved(read_png((self.work / picture).read_bytes())) for picture in line]
            rows += [b''.join(parts) for parts in zip(*pictures)]
        (self.work / name).write_bytes(write_png(rows))
        self.script.append(f'# {name}: ' + '; '.join(' '.join(str(picture) for picture in line) for line in lines) + ', side by side at half their size')
        self.keep(name)

    def provenance(self):
        """A sentence for under a table of times: the commands (their file where they are many), the day, the machine."""
        lines = list(dict.fromkeys(f'`{line}`' for line in self.script if line.startswith(('plisse', 'tools/'))))
        commands = '; '.join(lines) if len(lines) <= 3 else f'Commands: [{self.recipe.name}.sh](figures/{self.recipe.name}.sh)'
        return f'{commands}: {self.began}'

    def table(self, name, header, rows, page=None, note=''):
        """docs/figures/NAME.csv, and as Markdown between the table's marks in `page` of docs/."""
        with open(self.work / f'{name}.csv', 'w', newline='') as out:
            csv.writer(out).writerows([header, *rows])
        self.keep(f'{name}.csv')
        if page and self.pages:
            path = ROOT / 'docs' / page
            text = path.read_text()
            begin, end = table_mark(name, 'begin'), table_mark(name, 'end')
            if begin not in text or end not in text:
                sys.exit(f'docs/{page}: no "{begin}" … "{end}" for the table to stand between')
            head, tail = text.split(begin)[0], text.split(end)[1]
            body = markdown(header, rows) + (f'\n\n{note}' if note else '')
            path.write_text(f'{head}{begin}\n{body}\n{end}{tail}')

    def finish(self):
        """Writes the commands down; the names of what was made."""
        missing = set(self.recipe.makes) - set(self.kept)
        if missing:
            sys.exit(f'tools/recipes/{self.recipe.name}.py: it did not make {", ".join(sorted(missing))}')
        about = f'# {self.recipe.about}: {", ".join(self.recipe.makes)}\n# (tools/figures {self.recipe.name})\n'
        lines = []
        for line, again in itertools.groupby(self.script):
            times = len(list(again))
            lines.append(line if times == 1 else f'for i in $(seq {times}); do {line}; done')
        (self.folder / f'{self.recipe.name}.sh').write_text(about + '\n'.join(lines) + '\n')
        return self.kept
