#!/usr/bin/env python3
"""Impedance of the default slider's film by a scheme of its own, for tests/physics/film_flight.rs.

Finite volumes on an edge-fitted grid, one exponential profile (Scharfetter and Gummel 1969) per half
cell, pressure at the cells' centres times their areas as force: no corrections at corners, no slopes
along the wind, no layers in the force, derivatives by complex steps, sparse direct solution. It
shares no code with opshock. On the grid G2 of head_default_set.json it gives that file's stiffness
within 1 % and its damping within 1.5 % (the scheme there is another one again).

    python3 tests/reference/plain_film.py 1 2 4 6 > tests/reference/impedance_plain_scheme.json

runs it on G2 with every cell cut into k x k (34592 cells at k = 4, 77832 at 6). Needs numpy, scipy.
"""
import json
import os
import sys

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as direct

HERE = os.path.dirname(os.path.abspath(__file__))
DATA = json.load(open(os.path.join(HERE, "head_default_set.json")))["parameters"]
SURFACE, GAS, SLIDER = DATA["ABS"], DATA["gas"], DATA["slider"]
LENGTH, WIDTH = SURFACE["L"] * 1e-6, SURFACE["W"] * 1e-6
AMBIENT, VISCOSITY, PATH = GAS["pa"], GAS["mu"], GAS["lambda_ref"]
WIND = 6 * VISCOSITY * SLIDER["rpm"] * 2 * np.pi / 60 * SLIDER["r"]
FREQUENCIES = (1.0, 1e3, 1e4, 5e4, 1e5, 2e5, 5e5)
STEP = 1e-30


def recess(x, y):
    depth = np.full(x.shape, SURFACE["base"])
    for x0, x1, y0, y1, d in DATA["rects_um_and_recess_m"]:
        inside = (x > x0 * 1e-6) & (x < x1 * 1e-6) & (y > y0 * 1e-6) & (y < y1 * 1e-6)
        depth = np.where(inside, d, depth)
    return depth


def height(q, x, y, depth):
    u, v = 2 * x / LENGTH - 1, 2 * y / WIDTH - 1
    form = SURFACE["crown"] * u * u + SURFACE["camber"] * v * v
    return q[0] - q[1] * (x - LENGTH / 2) + q[2] * (y - WIDTH / 2) + depth + form


def flow_factor(psi):
    """Fukui and Kaneko (1990), three ranges."""
    d = np.sqrt(np.pi) / 2 * psi / (PATH * AMBIENT)
    thick = d / 6 + 1.0162 + 1.0653 / d - 2.1354 / d**2
    middle = 0.13852 * d + 1.25087 + 0.15653 / d - 0.00969 / d**2
    thin = -2.22919 * d + 2.10673 + 0.01653 / d - 0.0000694 / d**2
    size = np.real(d)
    return 6 / d * np.where(size >= 5, thick, np.where(size >= 0.15, middle, thin))


def bernoulli(x):
    near = np.abs(x) < 1e-3
    safe = np.where(near, 1.0, x)
    return np.where(near, 1 - x / 2 + x * x / 12, safe / (np.exp(safe) - 1))


def half_cell(psi, h_centre, h_face, distance, wind):
    """a, b of the outward flux a - b p_face per width."""
    g = flow_factor(psi) * psi
    ratio = h_face / h_centre
    flat = np.abs(ratio - 1) < 1e-7
    mean = np.where(flat, h_centre, (h_face - h_centre) / np.log(np.where(flat, 2.0, ratio)))
    k = g * mean / distance
    peclet = (wind + g * (h_face - h_centre) / distance) / k
    return k * bernoulli(-peclet) * psi, k * bernoulli(peclet) * h_face


class Film:
    def __init__(self, k):
        def cut(lines):
            parts = [np.linspace(a, b, k, endpoint=False) for a, b in zip(lines, lines[1:])]
            return np.concatenate(parts + [lines[-1:]])

        self.lines = [cut(np.array(lines)) for lines in DATA["grids"]["G2"]]
        self.widths = [np.diff(lines) for lines in self.lines]
        self.middles = [(lines[1:] + lines[:-1]) / 2 for lines in self.lines]
        self.x, self.y = np.meshgrid(*self.middles, indexing="ij")
        self.depth = recess(self.x, self.y)
        self.area = np.outer(*self.widths)
        self.shape = self.x.shape
        arms = [np.ones(self.shape), -(self.x - LENGTH / 2), self.y - WIDTH / 2]
        self.arms = np.array([arm.ravel() for arm in arms])

    def residual(self, psi, q):
        """Net outward flux of every cell."""
        psi = psi.reshape(self.shape)
        out = np.zeros_like(psi) + 0 * q[0]
        centre = height(q, self.x, self.y, self.depth)
        for d, wind in ((0, WIND), (1, 0.0)):
            places = [self.lines[0], self.middles[1]] if d == 0 else [self.middles[0], self.lines[1]]
            x, y = np.meshgrid(*places, indexing="ij")
            distance = np.expand_dims(self.widths[d], 1 - d) / 2 + 0 * self.x
            across = np.expand_dims(self.widths[1 - d], d)

            def pick(array, part):
                return array[part] if d == 0 else array[:, part]

            def side(cells, faces, sign):
                at = pick(x, faces), pick(y, faces), pick(self.depth, cells)
                return half_cell(
                    pick(psi, cells), pick(centre, cells), height(q, *at), pick(distance, cells), sign * wind
                )

            low, high = slice(None, -1), slice(1, None)
            a, b = side(low, slice(1, -1), 1)
            c, e = side(high, slice(1, -1), -1)
            flux = (a - b * (a + c) / (b + e)) * across
            pick(out, low)[...] += flux
            pick(out, high)[...] -= flux
            for end, sign in ((slice(0, 1), -1), (slice(-1, None), 1)):
                a, b = side(end, end, sign)
                pick(out, end)[...] += (a - b * AMBIENT) * across
        return out.ravel()

    def derivatives(self, psi, q):
        """d residual/d psi (sparse) and d residual/d q, by complex steps of five colours."""
        n_x, n_y = self.shape
        number = np.arange(n_x * n_y).reshape(self.shape)
        colours = (np.arange(n_x)[:, None] + 2 * np.arange(n_y)) % 5
        rows, columns, values = [], [], []
        for colour in range(5):
            chosen = colours == colour
            change = np.imag(self.residual(psi * (1 + 1j * STEP * chosen.ravel()), q)) / STEP
            change = change.reshape(self.shape)
            i, j = np.nonzero(chosen)
            for di, dj in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)):
                to = i + di, j + dj
                real = (to[0] >= 0) & (to[0] < n_x) & (to[1] >= 0) & (to[1] < n_y)
                to, source = (to[0][real], to[1][real]), number[i[real], j[real]]
                rows.append(number[to])
                columns.append(source)
                values.append(change[to] / psi[source])
        entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
        by_q = []
        for k in range(3):
            shifted = np.array(q, dtype=complex)
            shifted[k] += 1j * STEP
            by_q.append(np.imag(self.residual(psi.astype(complex), shifted)) / STEP)
        return sparse.csc_matrix(entries, shape=(n_x * n_y,) * 2), np.array(by_q).T

    def force(self, psi, q):
        h = height(q, self.x, self.y, self.depth).ravel()
        area = self.area.ravel()
        by_q = -(self.arms * (psi * area / h**2)) @ self.arms.T
        return self.arms @ ((psi / h - AMBIENT) * area), self.arms * (area / h), by_q

    def fly(self, q):
        psi = (AMBIENT * height(q, self.x, self.y, self.depth)).ravel()
        for _ in range(12):
            by_psi, _ = self.derivatives(psi, q)
            psi = np.maximum(psi - direct.spsolve(by_psi, self.residual(psi, q)), 0.1 * psi)
        load = np.array([SLIDER["load"], 0.0, 0.0])
        for _ in range(40):
            by_psi, by_q = self.derivatives(psi, q)
            factors = direct.splu(by_psi)
            columns, rest = factors.solve(by_q), factors.solve(self.residual(psi, q))
            force, force_by_psi, force_by_q = self.force(psi, q)
            stiffness = force_by_q - force_by_psi @ columns
            change = np.linalg.solve(stiffness, load - force + force_by_psi @ rest)
            step = -rest - columns @ change
            share = min(1.0, 2e-9 / np.abs(self.arms.T @ change).max())
            q, psi = q + share * change, np.maximum(psi + share * step, 0.2 * psi)
            if np.max(np.abs(step / psi)) < 1e-10:
                return psi, q
        raise RuntimeError("no steady flight")

    def impedance(self, psi, q):
        by_psi, by_q = self.derivatives(psi, q)
        _, force_by_psi, force_by_q = self.force(psi, q)
        capacity = sparse.diags(12 * VISCOSITY * self.area.ravel())
        for frequency in FREQUENCIES:
            omega = 2 * np.pi * frequency
            factors = direct.splu((by_psi + 1j * omega * capacity).tocsc())
            z = force_by_psi @ factors.solve(by_q.astype(complex)) - force_by_q
            yield {"f": frequency, "K": np.real(z).tolist(), "C": (np.imag(z) / omega).tolist()}


def main():
    grids = []
    for k in map(int, sys.argv[1:]):
        film = Film(k)
        psi, q = film.fly(np.array([43.08e-9, 113.04e-6, 0.0]))
        rows = list(film.impedance(psi, q))
        grids.append({"k": k, "cells": film.area.size, "hc_m": q[0], "pitch_rad": q[1], "rows": rows})
        print(k, film.area.size, q, file=sys.stderr)
    what = (
        "Impedance Z = -dF/dq of the default slider's film, q = (h_c, pitch, roll), C = Im Z/omega, by "
        "tests/reference/plain_film.py on the grid G2 with every cell cut into k x k. First order: "
        "the limit is z_2 + (z_2 - z_1) k_1/(k_2 - k_1) of two grids."
    )
    json.dump({"what": what, "grids": grids}, sys.stdout, indent=1)


if __name__ == "__main__":
    main()
