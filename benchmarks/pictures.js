async (seconds, everyPixel) => {
  // Plays the run that is open from its start, and notes how long each picture of a movement took.
  const { show, seeing: { stage } } = studio;
  const [gaps, script] = [[], []];
  const frame = stage.frame.bind(stage);
  let [last, drawn] = [0, stage.stats.frames];
  stage.frame = (now) => {
    const begin = performance.now();
    frame(now);
    if (stage.stats.frames === drawn) {
      last = 0;
      return;
    }
    script.push(performance.now() - begin);
    if (last) gaps.push(now - last);
    last = now;
    drawn = stage.stats.frames;
  };
  if (everyPixel) {
    stage.quality.level = 4;
    stage.quality.note = () => false;
    stage.resize();
  }
  show.player.seek(show.track.start);
  show.player.playing = true;
  await new Promise((done) => setTimeout(done, seconds * 1000));
  stage.frame = frame;
  const gl = stage.renderer.getContext();
  const about = gl.getExtension("WEBGL_debug_renderer_info");
  const loaded = ["navigation", "resource"].flatMap((kind) => performance.getEntriesByType(kind));
  return {
    gaps,
    script,
    ...stage.stats,
    programs: stage.renderer.info.programs.length,
    renderer: gl.getParameter(about ? about.UNMASKED_RENDERER_WEBGL : gl.RENDERER),
    bytes: loaded.filter(({ name }) => name.startsWith("http")).reduce((sum, { encodedBodySize }) => sum + encodedBodySize, 0),
  };
}
