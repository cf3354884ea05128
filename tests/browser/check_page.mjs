// Opens the report in Chromium and checks what a reader relies on. Usage: check_page.mjs INDEX.html
// Exit status 0 when every check holds; otherwise 1, with a line for each that does not.

import assert from 'node:assert/strict';
import { readFileSync, statSync } from 'node:fs';
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';

// Packages lie beside this file or where NODE_MODULES_HOME says (the build folder).
const home = process.env.NODE_MODULES_HOME ?? new URL('.', import.meta.url).pathname;
const require = createRequire(`${home}/package.json`);
const { chromium } = require('playwright-core');
const axe = readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');

const file = process.argv[2];
const url = pathToFileURL(file).href;
const MOST_BYTES = 3e6;

/** A page at the report, with everything that it logs or asks for. */
async function opened(browser, options = {}) {
  const context = await browser.newContext(options);
  const page = await context.newPage();
  const seen = { errors: [], requests: [] };
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type())) seen.errors.push(message.text());
  });
  page.on('pageerror', (error) => seen.errors.push(String(error)));
  page.on('request', (request) => {
    if (request.url() !== url && !request.url().startsWith('data:')) seen.requests.push(request.url());
  });
  await page.goto(url, { waitUntil: 'load' });
  return { page, seen, close: () => context.close() };
}

/** Elements that reach beyond the window and do not lie in a box that scrolls. */
const sticking = () => {
  const width = document.documentElement.clientWidth;
  return [...document.querySelectorAll('main *')]
    .filter((e) => e.getBoundingClientRect().right > width + 1 && !e.closest('.scroll, svg, .unseen, .screen'))
    .map((e) => `${e.tagName}.${e.className}`);
};

const checks = {
  async 'is one file below 3 MB, says nothing to the console and asks for nothing'(browser) {
    assert.ok(statSync(file).size < MOST_BYTES, `${statSync(file).size} bytes`);
    const { page, seen, close } = await opened(browser);
    await page.evaluate(() => window.scrollTo(0, document.body.scrollHeight));
    await page.waitForTimeout(300);
    assert.deepEqual(seen, { errors: [], requests: [] });
    const broken = await page.$$eval('img', (all) => all.filter((i) => !i.complete || !i.naturalWidth).length);
    assert.equal(broken, 0, 'pictures that do not load');
    await close();
  },

  async 'does not overflow sideways at 360 pixels'(browser) {
    const { page, close } = await opened(browser, { viewport: { width: 360, height: 740 } });
    await page.$$eval('details', (all) => all.forEach((d) => { d.open = true; }));
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= 360, `${wide} pixels wide; beyond: ${await page.evaluate(sticking)}`);
    assert.deepEqual(await page.evaluate(sticking), []);
    await close();
  },

  async 'prints: white paper, no contents, nothing cut off'(browser) {
    const { page, close } = await opened(browser, { viewport: { width: 688, height: 1000 }, colorScheme: 'dark' });
    await page.emulateMedia({ media: 'print', colorScheme: 'dark' });
    const look = await page.evaluate(() => ({
      paper: getComputedStyle(document.body).backgroundColor,
      contents: getComputedStyle(document.querySelector('nav')).display,
      cut: [...document.querySelectorAll('table, svg.chart, img')]
        .filter((e) => (e.offsetParent !== null || e.tagName === 'svg') && !e.closest('.screen')) // sheets show a part
        .filter((e) => e.getBoundingClientRect().right > document.documentElement.clientWidth + 1)
        .map((e) => e.caption?.textContent ?? e.getAttribute('aria-label') ?? e.tagName),
    }));
    assert.deepEqual(look, { paper: 'rgb(255, 255, 255)', contents: 'none', cut: [] });
    const pdf = await page.pdf({ preferCSSPageSize: true });
    assert.equal(pdf.subarray(0, 5).toString(), '%PDF-');
    await close();
  },

  async 'has no serious accessibility violation, light or dark'(browser) {
    for (const colorScheme of ['light', 'dark']) {
      const { page, close } = await opened(browser, { colorScheme });
      await page.$$eval('details', (all) => all.forEach((d) => { d.open = true; }));
      await page.evaluate(axe);
      const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ['violations'] }));
      const serious = violations.filter((v) => ['serious', 'critical'].includes(v.impact));
      const told = serious.map((v) => `${v.id}: ${v.nodes.slice(0, 3).map((n) => n.html.slice(0, 120)).join(' | ')}`);
      assert.deepEqual(told, [], colorScheme);
      await close();
    }
  },

  async 'has a label on every drawing, unique ids, headings in order'(browser) {
    const { page, close } = await opened(browser);
    const found = await page.evaluate(() => {
      const bare = [...document.querySelectorAll('svg')].filter((s) => s.getAttribute('aria-hidden') !== 'true' &&
        !(s.getAttribute('role') === 'img' && (s.getAttribute('aria-label') ?? '').length > 10));
      const ids = [...document.querySelectorAll('[id]')].map((e) => e.id);
      const dangling = [...document.querySelectorAll('svg use')].map((u) => u.getAttribute('href').slice(1))
        .filter((id) => !ids.includes(id));
      const levels = [...document.querySelectorAll('h1, h2, h3, h4')].map((h) => +h.tagName[1]);
      return {
        bare: bare.length, twice: ids.filter((id, i) => ids.indexOf(id) !== i), dangling,
        jumps: levels.filter((l, i) => i > 0 && l > levels[i - 1] + 1).length,
        noCaption: [...document.querySelectorAll('table')].filter((t) => !t.caption).length,
        charts: document.querySelectorAll('svg.chart').length > 0,
        deadLinks: [...document.querySelectorAll('a[href^="#"]')].filter((a) => !document.getElementById(a.hash.slice(1))).length,
      };
    });
    assert.deepEqual(found, { bare: 0, twice: [], dangling: [], jumps: 0, noCaption: 0, charts: true, deadLinks: 0 });
    await close();
  },

  async 'sorts a table both ways and keeps missing values last'(browser) {
    const { page, close } = await opened(browser);
    const table = page.locator('table.sortable', { hasText: 'local order' }).first();
    const head = table.locator('thead th', { hasText: 'local order' });
    const column = await head.evaluate((th) => [...th.parentNode.children].indexOf(th));
    const values = () => table.evaluate((t, k) => [...t.tBodies[0].rows].map((r) => r.cells[k].dataset.v ?? null), column);
    const before = await values();
    assert.ok(before.includes(null) && before.some((v) => v !== null), 'the fixture has both kinds');
    for (const [sign, word] of [[1, 'ascending'], [-1, 'descending']]) {
      await head.locator('button').click();
      assert.equal(await head.getAttribute('aria-sort'), word);
      const after = await values();
      const known = after.filter((v) => v !== null).map(Number);
      assert.deepEqual(after.slice(known.length).filter((v) => v !== null), [], 'missing values last');
      assert.deepEqual(known, [...known].sort((a, b) => sign * (a - b)), word);
      assert.equal(after.length, before.length);
    }
    await close();
  },

  async 'lights up a curve from the key, by mouse and by keyboard'(browser) {
    const { page, close } = await opened(browser);
    const entry = page.locator('.key li').first();
    const faded = () => page.evaluate(() => document.querySelectorAll('.charts.picking .curve:not(.on)').length);
    assert.equal(await faded(), 0);
    await entry.hover();
    assert.ok(await faded() > 0);
    await page.mouse.move(0, 0);
    await entry.focus();
    assert.ok(await faded() > 0);
    await close();
  },

  async 'lights up a curve that a plot names itself, in all plots of the study'(browser) {
    const { page, close } = await opened(browser);
    const label = page.locator('svg.chart .curve', { has: page.locator('text') }).first();
    const name = await label.getAttribute('data-case');
    await label.locator('text').first().hover();
    const lit = await page.evaluate((k) => ({
      faded: document.querySelectorAll('.picking .curve:not(.on)').length,
      wrong: [...document.querySelectorAll('.picking .curve.on')].filter((c) => c.dataset.case !== k).length,
    }), name);
    assert.ok(lit.faded > 0);
    assert.equal(lit.wrong, 0);
    await close();
  },

  async 'plays an animation on a click alone, by slider and by keyboard, its panels together'(browser) {
    const { page, close } = await opened(browser, { reducedMotion: 'reduce' });
    const figure = page.locator('[data-film]').first();
    const film = JSON.parse(await figure.getAttribute('data-film'));
    const places = () => figure.locator('.screen img').evaluateAll((all) => all.map((i) => `${i.style.left} ${i.style.top}`));
    const time = () => figure.locator('output').textContent();
    const weight = await figure.locator('.screen img').evaluateAll((all) => all.reduce((sum, i) => sum + i.src.length * 0.75, 0));
    assert.ok(weight < 1e6, `${weight} bytes`);
    const last = await places();
    assert.ok(last.length > 1 && new Set(last).size === 1);
    assert.equal(await time(), film.times.at(-1));
    await page.waitForTimeout(500);
    assert.deepEqual(await places(), last, 'nothing moves by itself');
    const slider = figure.locator('input');
    await slider.focus();
    await page.keyboard.press('Home');
    assert.equal(await time(), film.times[0]);
    assert.equal(await slider.getAttribute('aria-valuetext'), film.times[0]);
    assert.notDeepEqual(await places(), last);
    assert.equal(new Set(await places()).size, 1);
    const button = figure.locator('.player button');
    await button.click();
    assert.match(await button.textContent(), /Pause/);
    await page.waitForFunction((end) => document.querySelector('[data-film] output').textContent === end, film.times.at(-1));
    assert.match(await button.textContent(), /Play/);
    assert.deepEqual(await places(), last);
    await close();
  },

  async 'leads from a cell of a heat map to its evidence, whose command can be copied'(browser) {
    const { page, close } = await opened(browser, { permissions: ['clipboard-read', 'clipboard-write'] });
    const command = page.locator('.evidence .command').first();
    assert.ok(!await command.isVisible(), 'folded up at first');
    await page.locator('.heat td a').first().click();
    await command.waitFor({ state: 'visible' });
    await command.locator('button').click();
    await page.waitForFunction(() => document.querySelector('.command button').textContent === 'Copied');
    assert.equal(await page.evaluate(() => navigator.clipboard.readText()), await command.locator('code').textContent());
    await close();
  },

  async 'tells a heat map without its colours: a disc as full as the score, and words'(browser) {
    const { page, close } = await opened(browser);
    const cells = await page.$$eval('.heat td', (all) => all.map((c) => ({
      step: c.className.slice(1), disc: c.querySelector('.pie path')?.getAttribute('d') ?? '',
      pie: c.querySelector('.pie') !== null, words: c.textContent, ground: getComputedStyle(c).backgroundColor })));
    for (const cell of cells.filter((c) => c.step)) {
      assert.match(cell.words, /score [01]\.\d\d/);
      assert.equal(cell.disc === '', cell.step === '0');
    }
    assert.ok(cells.some((c) => !c.step && !c.pie), 'the fixture has a cell without a number');
    const grounds = (step) => new Set(cells.filter((c) => c.step === step).map((c) => c.ground));
    assert.equal(grounds('0').size, 1);
    assert.notDeepEqual(grounds('0'), grounds('10'));
    await close();
  },

  async 'is whole without JavaScript'(browser) {
    const { page, close } = await opened(browser, { javaScriptEnabled: false });
    assert.ok(await page.locator('#verdicts table tbody tr').count() > 0);
    assert.ok(await page.locator('svg.chart').first().isVisible());
    assert.equal(await page.locator('th button, .player').count(), 0);
    const shown = await page.locator('.screen').first().evaluate((screen) => {
      const box = screen.getBoundingClientRect(), sheet = screen.querySelector('img').getBoundingClientRect();
      const n = +screen.querySelector('img').dataset.count - 1, across = +screen.querySelector('img').dataset.across;
      return [(box.left - sheet.left) / box.width - n % across, (box.top - sheet.top) / box.height - Math.floor(n / across)];
    });
    assert.ok(shown.every((off) => Math.abs(off) < 0.02), `the last frame of an animation stands still: off by ${shown}`);
    await close();
  },
};

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: ['--no-sandbox', '--disable-gpu', '--disable-background-networking', '--disable-sync',
    '--disable-component-update', '--no-first-run', '--host-resolver-rules=MAP * ~NOTFOUND'],
});
let failed = 0;
for (const [name, check] of Object.entries(checks)) {
  try {
    await check(browser);
    console.log(`ok    ${name}`);
  } catch (error) {
    failed += 1;
    console.log(`FAIL  ${name}\n      ${String(error.message).replaceAll('\n', '\n      ')}`);
  }
}
await browser.close();
process.exitCode = failed ? 1 : 0;
