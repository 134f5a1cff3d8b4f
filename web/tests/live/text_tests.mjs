// The texts of the pages: every one that is used is there, and translations say the same things.
import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { describe, it } from 'node:test';
import { fileURLToPath } from 'node:url';

const source = join(dirname(fileURLToPath(import.meta.url)), '../../src');
const textOf = (name) => readFileSync(join(source, 'shared/texts', name), 'utf8');
const read = (name) => JSON.parse(textOf(name));
const placeholders = (text) => [...text.matchAll(/\{(\w+)\}/g)].map(([, name]) => name).sort();
const isNamed = (key) => /^(name|count)\./.test(key); // what the domain names: English has only names that do not read well

function sources(folder) {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
    if (entry.isDirectory()) return sources(join(folder, entry.name));
    return /\.tsx?$/.test(entry.name) ? [readFileSync(join(folder, entry.name), 'utf8')] : [];
  });
}

export function textTests() {
  describe('texts', () => {
    const english = read('en.json');
    const code = ['shared', 'live', 'lesson', 'file'].flatMap((folder) => sources(join(source, folder))).join('\n');

    it('are there for every key that a screen uses', () => {
      const has = (key) => key in english || `${key}.other` in english;
      const used = [...code.matchAll(/'([a-z]+\.[a-z_.-]+)'/g)].map(([, key]) => key);
      const families = new Set(Object.keys(english).map((key) => key.split('.')[0]));
      const missing = used.filter((key) => families.has(key.split('.')[0]) && !has(key) && key !== 'consent.txt');
      assert.deepEqual(missing, []);
    });

    it('are all used', () => {
      const stems = [...code.matchAll(/`([a-z]+(?:\.[a-z]+)?\.)\$\{/g)].map(([, stem]) => stem);
      const isUsed = (key) => {
        const plain = key.replace(/\.(zero|one|two|few|many|other)$/, '');
        return code.includes(`'${key}'`) || code.includes(`'${plain}'`) || stems.some((stem) => key.startsWith(stem));
      };
      assert.deepEqual(Object.keys(english).filter((key) => !isUsed(key)), []);
    });

    it('contain no terms of ours', () => {
      const terms = /\b(demonstrations?|components?|beliefs?|rewards?|weights|polic(y|ies)|regret|periods?|strateg(y|ies)|teacher|learners?|seats?)\b/i;
      assert.deepEqual(Object.values(english).filter((text) => terms.test(text)), []);
    });

    const files = readdirSync(join(source, 'shared/texts'));
    for (const name of files) {
      it(`of ${name} have one text for every key`, () => {
        const keys = [...textOf(name).matchAll(/^ {2}"([^"]+)": /gm)].map(([, key]) => key);
        assert.deepEqual(keys.filter((key, i) => keys.indexOf(key) !== i), []);
        assert.deepEqual(keys, Object.keys(read(name)));
        assert.deepEqual(Object.entries(read(name)).filter(([, text]) => text.trim() === ''), []);
      });
    }

    it('in German address people formally', () => {
      const informal = /\b(du|dich|dir|dein\w*|euch|eure?\w*)\b/i;
      assert.deepEqual(Object.values(read('de.json')).filter((text) => informal.test(text)), []);
    });

    for (const name of files.filter((file) => file !== 'en.json')) {
      it(`of ${name} have the keys and placeholders of English`, () => {
        const own = read(name);
        assert.deepEqual(Object.keys(own).filter((key) => !(key in english) && !isNamed(key)), []);
        assert.deepEqual(Object.keys(english).filter((key) => !(key in own)), []);
        for (const [key, text] of Object.entries(english)) assert.deepEqual(placeholders(own[key]), placeholders(text), key);
      });
    }
  });
}
