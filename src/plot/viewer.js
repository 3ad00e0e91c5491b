// The moving mechanism of a report: played, scrubbed, turned. Needs THREE and `floeMotion`, which report.py writes:
//   x = R + A (X + a u),  u = sum_j basis_j eta_j, or as it was sampled
(function () {
  "use strict";
  const motion = window.floeMotion, frames = motion.t.length;
  const box = document.getElementById("mechanism"), note = document.getElementById("mechanism-note");

  const bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer;
  const reals = text => new Float32Array(bytes(text)), numbers = text => new Uint32Array(bytes(text));

  const bodies = motion.bodies.map(b => ({
    name: b.name, rigid: b.rigid, nodes: b.nodes, k: b.k, X: reals(b.X), frames: reals(b.frames),
    basis: b.k ? reals(b.basis) : null, eta: b.k ? reals(b.eta) : null, u: b.u ? reals(b.u) : null,
    lines: numbers(b.lines), triangles: numbers(b.triangles), edges: numbers(b.edges),
    deformation: new Float32Array(3 * b.nodes), x: new Float32Array(3 * b.nodes)
  }));

  const state = { frame: 0, playing: false, amplify: 1, speed: 1, azimuth: 0, elevation: 0, distance: 1, target: null };

  // --- places of the nodes
  function deform(body, frame) {
    const u = body.deformation, n = 3 * body.nodes;
    if (body.u) u.set(body.u.subarray(frame * n, (frame + 1) * n));
    else u.fill(0);
    for (let j = 0; j < body.k; ++j) {
      const eta = body.eta[frame * body.k + j], at = j * n;
      for (let i = 0; i < n; ++i) u[i] += eta * body.basis[at + i];
    }
  }
  function place(body, frame) {
    deform(body, frame);
    const F = body.frames, at = 12 * frame, a = state.amplify, u = body.deformation, X = body.X, x = body.x;
    for (let i = 0; i < x.length; i += 3) {
      const p = X[i] + a * u[i], q = X[i + 1] + a * u[i + 1], r = X[i + 2] + a * u[i + 2];
      for (let d = 0; d < 3; ++d)
        x[i + d] = F[at + d] + F[at + 3 + 3 * d] * p + F[at + 4 + 3 * d] * q + F[at + 5 + 3 * d] * r;
    }
  }
  const length = (u, i) => Math.hypot(u[3 * i], u[3 * i + 1], u[3 * i + 2]);

  // --- colours: viridis, as in the pictures
  const stops = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
  function colour(value, to, at) {
    const s = 4 * Math.min(1, Math.max(0, value)), i = Math.min(3, Math.floor(s)), f = s - i;
    for (let c = 0; c < 3; ++c) to[at + c] = ((1 - f) * stops[i][c] + f * stops[i + 1][c]) / 255;
  }

  let renderer, scene, camera, size, low, high;
  function extent() {
    low = [Infinity, Infinity, Infinity]; high = [-Infinity, -Infinity, -Infinity];
    for (let f = 0; f < frames; f += Math.max(1, Math.floor(frames / 25)))
      for (const body of bodies) {
        place(body, f);
        for (let i = 0; i < body.x.length; ++i) {
          low[i % 3] = Math.min(low[i % 3], body.x[i]); high[i % 3] = Math.max(high[i % 3], body.x[i]);
        }
      }
    size = Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]) || 1;
  }

  const sides = 8;
  function makeBody(body) {
    body.parts = [];
    const attribute = (count, width) => new THREE.BufferAttribute(new Float32Array(count * width), width);
    if (body.triangles.length) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", attribute(body.nodes, 3));
      geometry.setAttribute("color", attribute(body.nodes, 3));
      geometry.setIndex(new THREE.BufferAttribute(body.triangles, 1));
      const surface = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({
        vertexColors: THREE.VertexColors, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }));
      const wires = new THREE.BufferGeometry();
      wires.setAttribute("position", geometry.getAttribute("position"));
      wires.setIndex(new THREE.BufferAttribute(body.edges, 1));
      const edges = new THREE.LineSegments(wires, new THREE.LineBasicMaterial({ color: 0x222222, transparent: true, opacity: 0.35 }));
      surface.frustumCulled = edges.frustumCulled = false;
      scene.add(surface, edges);
      body.surface = geometry;
    }
    if (body.lines.length) {  // beams are tubes: WebGL draws lines one pixel wide
      const count = body.lines.length / 2, index = new Uint32Array(count * sides * 6);
      for (let e = 0, at = 0; e < count; ++e)
        for (let s = 0; s < sides; ++s) {
          const a = 2 * sides * e + s, b = 2 * sides * e + (s + 1) % sides;
          for (const i of [a, b, a + sides, b, b + sides, a + sides]) index[at++] = i;
        }
      const geometry = new THREE.BufferGeometry();
      for (const name of ["position", "normal", "color"]) geometry.setAttribute(name, attribute(count * sides * 2, 3));
      geometry.setIndex(new THREE.BufferAttribute(index, 1));
      const tubes = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ vertexColors: THREE.VertexColors, side: THREE.DoubleSide }));
      tubes.frustumCulled = false;
      scene.add(tubes);
      body.tubes = geometry;
    }
  }
  // --- joints: balls, boxes where they fix or slide; the ground as a grey pyramid below
  let joints = [];
  function makeJoints() {
    const radius = 0.011 * size, dark = new THREE.MeshLambertMaterial({ color: 0x333333 }),
      grey = new THREE.MeshLambertMaterial({ color: 0x9a9a9a });
    joints = (motion.joints || []).map(joint => {
      const slides = ["fixed", "prismatic", "driven_slide", "cylindrical", "planar"].includes(joint.kind);
      const ball = new THREE.Mesh(slides ? new THREE.BoxGeometry(1.7 * radius, 1.7 * radius, 1.7 * radius)
        : new THREE.SphereGeometry(radius, 16, 12), dark);
      scene.add(ball);
      if (joint.ground) {
        const foot = new THREE.Mesh(new THREE.ConeGeometry(2 * radius, 2.6 * radius, 4), grey);
        if (motion.dimension === 3) foot.rotation.x = Math.PI / 2;
        foot.position.set(...joint.ground);
        foot.position[motion.dimension === 3 ? "z" : "y"] -= 1.9 * radius;
        scene.add(foot);
      }
      return { ball, joint };
    });
  }
  function placeJoints(frame) {
    for (const { ball, joint } of joints) {
      const body = bodies[joint.body], at = 12 * frame, F = body.frames, way = joint.way;
      const x = [0, 1, 2].map(d => body.x[3 * joint.node + d] + F[at + 3 + 3 * d] * way[0] + F[at + 4 + 3 * d] * way[1]
        + F[at + 5 + 3 * d] * way[2]);
      ball.position.set(...x);
    }
  }
  const shade = (body, i, to, at) => {  // rigid bodies are grey
    if (body.rigid) to[at] = to[at + 1] = to[at + 2] = 0.55;
    else colour(length(body.deformation, i) / motion.greatest, to, at);
  };
  function drawSurface(body) {
    const position = body.surface.getAttribute("position"), colours = body.surface.getAttribute("color");
    position.array.set(body.x);
    for (let i = 0; i < body.nodes; ++i) shade(body, i, colours.array, 3 * i);
    position.needsUpdate = colours.needsUpdate = true;
    body.surface.computeVertexNormals();
  }
  const a = [0, 0, 0], v = [0, 0, 0], w = [0, 0, 0];
  function drawTubes(body) {
    const position = body.tubes.getAttribute("position"), normal = body.tubes.getAttribute("normal"),
      colours = body.tubes.getAttribute("color"), radius = 0.006 * size, x = body.x;
    for (let e = 0; 2 * e < body.lines.length; ++e) {
      const ends = [body.lines[2 * e], body.lines[2 * e + 1]];
      let long = 0;
      for (let d = 0; d < 3; ++d) { a[d] = x[3 * ends[1] + d] - x[3 * ends[0] + d]; long += a[d] * a[d]; }
      long = Math.sqrt(long) || 1;
      for (let d = 0; d < 3; ++d) a[d] /= long;
      const least = Math.abs(a[0]) < Math.abs(a[1]) ? (Math.abs(a[0]) < Math.abs(a[2]) ? 0 : 2) : (Math.abs(a[1]) < Math.abs(a[2]) ? 1 : 2);
      const other = [0, 0, 0]; other[least] = 1;
      v[0] = a[1] * other[2] - a[2] * other[1]; v[1] = a[2] * other[0] - a[0] * other[2]; v[2] = a[0] * other[1] - a[1] * other[0];
      const norm = Math.hypot(v[0], v[1], v[2]) || 1;
      for (let d = 0; d < 3; ++d) v[d] /= norm;
      w[0] = a[1] * v[2] - a[2] * v[1]; w[1] = a[2] * v[0] - a[0] * v[2]; w[2] = a[0] * v[1] - a[1] * v[0];
      for (let end = 0; end < 2; ++end)
        for (let s = 0; s < sides; ++s) {
          const at = 3 * (2 * sides * e + sides * end + s), c = Math.cos(2 * Math.PI * s / sides), sn = Math.sin(2 * Math.PI * s / sides);
          for (let d = 0; d < 3; ++d) {
            normal.array[at + d] = c * v[d] + sn * w[d];
            position.array[at + d] = x[3 * ends[end] + d] + radius * normal.array[at + d];
          }
          shade(body, ends[end], colours.array, at);
        }
    }
    position.needsUpdate = normal.needsUpdate = colours.needsUpdate = true;
  }

  function look() {
    const e = state.elevation, z = state.azimuth, d = state.distance, t = state.target;
    const way = motion.dimension === 2  // the plane is seen from z
      ? [Math.sin(z) * Math.cos(e), Math.sin(e), Math.cos(z) * Math.cos(e)]
      : [Math.cos(e) * Math.cos(z), Math.cos(e) * Math.sin(z), Math.sin(e)];
    camera.up.set(0, motion.dimension === 2 ? 1 : 0, motion.dimension === 2 ? 0 : 1);
    camera.position.set(t[0] + d * way[0], t[1] + d * way[1], t[2] + d * way[2]);
    camera.lookAt(t[0], t[1], t[2]);
    lamp.position.copy(camera.position);
  }
  let lamp;
  function render() { look(); renderer.render(scene, camera); }
  function home() {
    state.azimuth = motion.dimension === 2 ? 0 : -60 * Math.PI / 180;
    state.elevation = motion.dimension === 2 ? 0 : 25 * Math.PI / 180;
    state.target = low.map((l, i) => 0.5 * (l + high[i]));
    const across = 2 * Math.tan(0.5 * camera.fov * Math.PI / 180) * Math.min(1, camera.aspect);
    state.distance = 1.05 * Math.max(size / across * 0.9, (high[0] - low[0]) / (across * Math.max(1, camera.aspect)));
    camera.near = 1e-3 * size; camera.far = 100 * size; camera.updateProjectionMatrix();
  }
  function show(frame) {
    state.frame = Math.max(0, Math.min(frames - 1, Math.round(frame)));
    for (const body of bodies) {
      place(body, state.frame);
      if (body.surface) drawSurface(body);
      if (body.tubes) drawTubes(body);
    }
    placeJoints(state.frame);
    slider.value = state.frame;
    clock.textContent = motion.labels ? motion.labels[state.frame] : "t = " + Number(motion.t[state.frame].toPrecision(4)) + " s";
    render();
  }

  // --- the controls
  const by = id => document.getElementById(id);
  const slider = by("mechanism-time"), clock = by("mechanism-clock"), play = by("mechanism-play"),
    amplify = by("mechanism-amplify"), speed = by("mechanism-speed");
  let started = 0, from = 0;
  function run(on) {
    state.playing = on;
    play.textContent = on ? "Pause" : "Play";
    if (!on) return;
    if (state.frame >= frames - 1) show(0);
    started = performance.now(); from = motion.t[state.frame];
    requestAnimationFrame(tick);
  }
  const span = (motion.t[frames - 1] - motion.t[0]) || 1;
  function tick() {  // the whole motion in 8 seconds at speed 1
    if (!state.playing) return;
    const t = from + (performance.now() - started) / 1000 * state.speed * span / 8;
    let frame = state.frame;
    while (frame < frames - 1 && motion.t[frame + 1] <= t) ++frame;
    if (frame !== state.frame) show(frame);
    if (frame >= frames - 1) run(false);
    else requestAnimationFrame(tick);
  }
  function drag(canvas) {
    let held = null;
    canvas.addEventListener("pointerdown", e => { held = [e.clientX, e.clientY, e.shiftKey || e.button === 2]; canvas.setPointerCapture && e.isTrusted && canvas.setPointerCapture(e.pointerId); });
    canvas.addEventListener("pointerup", () => { held = null; });
    canvas.addEventListener("contextmenu", e => e.preventDefault());
    canvas.addEventListener("pointermove", e => {
      if (!held) return;
      const dx = e.clientX - held[0], dy = e.clientY - held[1];
      held[0] = e.clientX; held[1] = e.clientY;
      if (held[2]) {
        const step = 2 * state.distance * Math.tan(0.5 * camera.fov * Math.PI / 180) / canvas.clientHeight;
        const m = camera.matrix.elements;
        for (let d = 0; d < 3; ++d) state.target[d] += step * (-dx * m[d] + dy * m[4 + d]);
      } else {
        state.azimuth += (motion.dimension === 2 ? -1 : -1) * 0.008 * dx;
        state.elevation = Math.max(-1.55, Math.min(1.55, state.elevation + 0.008 * dy));
      }
      render();
    });
    canvas.addEventListener("wheel", e => { e.preventDefault(); state.distance *= Math.exp(0.001 * e.deltaY); render(); }, { passive: false });
  }
  function resize() {
    const wide = box.clientWidth || 800, high_ = Math.round(Math.min(0.62 * wide, 560));
    renderer.setSize(wide, high_);
    camera.aspect = wide / high_;
    camera.updateProjectionMatrix();
  }

  function begin() {
    renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    renderer.setClearColor(0xf7f7f5);
    scene = new THREE.Scene();
    camera = new THREE.PerspectiveCamera(35, 1.6, 0.01, 100);
    extent();
    lamp = new THREE.DirectionalLight(0xffffff, 0.55);
    scene.add(new THREE.AmbientLight(0xffffff, 0.65), lamp);
    bodies.forEach(makeBody);
    makeJoints();
    box.appendChild(renderer.domElement);
    renderer.domElement.setAttribute("aria-label", "The mechanism in motion; drag to rotate");
    resize();
    home();
    slider.max = frames - 1;
    slider.addEventListener("input", () => { run(false); show(+slider.value); });
    play.addEventListener("click", () => run(!state.playing));
    amplify.addEventListener("input", () => { state.amplify = +amplify.value; by("mechanism-factor").textContent = "× " + amplify.value; show(state.frame); });
    speed.addEventListener("change", () => { state.speed = +speed.value; if (state.playing) { started = performance.now(); from = motion.t[state.frame]; } });
    by("mechanism-home").addEventListener("click", () => { home(); render(); });
    window.addEventListener("resize", () => { resize(); render(); });
    drag(renderer.domElement);
    show(0);
  }
  try {
    begin();
    window.floeView = { state, bodies, show, run, canvas: renderer.domElement };
  } catch (error) {
    note.textContent = "The animation needs WebGL, which this browser does not support (" + error.message + "). The pictures below do not need it.";
    by("mechanism-controls").hidden = true;
  }
})();
