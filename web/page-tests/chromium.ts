// How Chromium is started for the tests: the one that is installed, drawing without a graphics card.

export const CHROMIUM = process.env.CHROMIUM ?? "/usr/bin/chromium";
export const SOFTWARE = [
  "--no-sandbox",
  "--use-gl=angle",
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
  "--ignore-gpu-blocklist",
];
