// A board: the reader says first what the robot will do; then both paths are there, and why the robot takes its own.
import type { ComponentChildren, JSX } from 'preact';
import { useLayoutEffect, useRef, useState } from 'preact/hooks';
import type { Board, Path, PathKind } from '../shared/board/types';
import { Brackets } from '../shared/play/brackets';
import { Button } from '../shared/play/button';
import { Compare } from '../shared/play/compare';
import { Fan, stateAt } from '../shared/play/fan';
import { countsOf } from '../shared/play/ledger';
import { Mark } from '../shared/play/mark';
import { RunsView, type Runs } from '../shared/play/runs';
import { SmallBoard } from '../shared/play/small_board';
import { sentence, t } from '../shared/texts';
import { isExample, type Card } from './cards';
import { choiceText } from './choice';
import { partingOf, playBoard, usePrinting, type Context, type Guess } from './context';
import type { Demonstration, Sentence, Test } from './document';
import { askingText, Guessing } from './guess';

interface Props extends Context {
  card: Card;
  place: string; // "3 of 9"
  guess: Guess | null;
  isChoice: boolean; // the reader is asked which of two paths it is
  onGuess: (guess: Guess) => void;
  next: JSX.Element;
}

export function CardView({ card, place, guess, isChoice, onGuess, next, ...context }: Props): JSX.Element {
  const isPrinting = usePrinting();
  const { kind, shown } = card;
  const seen = guess ?? (isPrinting && isExample(shown) ? { mine: null, verdict: null } : null);
  return (
    <article class={`card ${kind === 'Example' ? 'demonstration' : 'test'}`}>
      <p class="kicker">
        {kind === 'New board' ? kind : `${kind}, board`} {place}
        {shown.world_name && `: ${shown.world_name}`}
      </p>
      {seen ? (
        <Seen {...context} shown={shown} guess={seen} isStill={isPrinting} next={next} />
      ) : (
        <>
          <Title isQuiet={isPrinting}>{isChoice ? `Which of these two ${shown.runs ? 'moves will it try' : 'paths will it take'}?` : askingText(context, shown)}</Title>
          {shown.runs && !isPrinting && !isChoice && context.worlds.asked(shown) === 'path' && <p>{t('predict.chance')}</p>}
          {isPrinting ? (
            <Whole {...context} board={{ ...shown, frames: shown.frames.slice(0, 1), runs: null }} />
          ) : (
            <Guessing {...context} shown={shown} isChoice={isChoice} submit={t('watch.sketched')} skip={isExample(shown) ? t('watch.skip') : 'Show the answer'} onGuess={onGuess} />
          )}
        </>
      )}
    </article>
  );
}

// Gets the focus when it appears, so that a screen reader says it, and whoever uses keys goes on from there.
export function Title({ isQuiet, children }: { isQuiet?: boolean; children: ComponentChildren }): JSX.Element {
  const title = useRef<HTMLHeadingElement>(null);
  useLayoutEffect(() => {
    if (isQuiet) return;
    title.current?.focus({ preventScroll: true });
    window.scrollTo(0, 0);
  }, []);
  return (
    <h2 tabIndex={-1} ref={title}>
      {children}
    </h2>
  );
}

// What the robot's path is compared with, one path at a time.
interface Pair {
  title: string;
  other: Path | null;
  isMine: boolean;
  at: number | null; // where the paths part
  reason: string;
}

// Whether somebody's path is another one. Where chance has a part, runs differ by themselves: then by its first move.
const differs = (shown: Demonstration | Test, mine: Path): boolean =>
  shown.runs ? shown.frames[0]?.action !== mine.frames[0]?.action : partingOf(shown, mine) !== null;

// First with one's own; what the board was chosen for, if that is something else, with the path that shows it.
function pairsOf(context: Context, shown: Demonstration | Test, { mine, verdict }: Guess): Pair[] {
  const isWrong = mine !== null && !verdict?.isRight;
  const why = isWrong ? whyNot(context, shown, mine) : '';
  const title = t(`feedback.title.${!mine ? 'none' : isWrong ? 'wrong' : 'right'}`);
  const isDrawn = mine !== null && (isWrong || (!shown.runs && differs(shown, mine)));
  const own: Pair = { title, other: isDrawn ? mine : null, isMine: true, at: isDrawn ? partingOf(shown, mine) : null, reason: why };
  if (!isExample(shown)) return [own];
  const taught: Pair = { title: isDrawn ? 'Now this one' : title, other: shown.alternative, isMine: false, at: shown.decisive?.frame ?? null, reason: shown.reason };
  if (!isDrawn) return [taught];
  if (!shown.alternative) return [own];
  return isAlike(shown, mine, shown.alternative) ? [{ ...own, reason: shown.reason }] : [own, taught];
}

// Whether what the board was chosen for is to be said of the reader's path, too.
function isAlike(shown: Demonstration, mine: Path, other: Path): boolean {
  const at = shown.decisive?.frame ?? 0;
  if (shown.runs) return partingOf(shown, mine) === at && mine.frames[at]?.action === other.frames[at]?.action;
  const [a, b] = [mine, other].map(({ frames, repeats_from }) => String([repeats_from, countsOf(frames)]));
  return a === b;
}

// Of the two paths that are drawn, where chance has no part in them.
function whyNot({ lesson }: Context, shown: Demonstration | Test, mine: Path): string {
  if (shown.runs) return '';
  const [isEndless, isMineEndless] = [shown, mine].map((path) => path.repeats_from !== undefined);
  if (isEndless && isMineEndless) return '';
  if (isMineEndless) return 'it would rather finish than go on for ever';
  return isEndless ? 'it would rather go on for ever than finish' : choiceText(lesson, countsOf(shown.frames), countsOf(mine.frames));
}

function Seen({ shown, guess, isStill, next, ...context }: Context & Pick<Props, 'guess' | 'next'> & { shown: Demonstration | Test; guess: Guess; isStill: boolean }): JSX.Element {
  const [beat, setBeat] = useState(0);
  const pairs = pairsOf(context, shown, guess);
  const pair = pairs[beat] ?? pairs[0];
  if (!pair) return next;
  const { domain, legend } = context;
  const board = playBoard(domain, shown);
  const isLast = beat === pairs.length - 1;
  const word = !guess.mine ? 'none' : guess.verdict?.isRight ? 'right' : 'wrong';
  const reason = <Reason reason={pair.reason} shown={shown} word={word} isAsGood={beat === 0 && word === 'right' && guess.mine !== null && differs(shown, guess.mine)} />;
  const goOn = (
    <>
      {isLast && isExample(shown) && <Brackets brackets={shown.brackets} counted={domain.counted} />}
      <div class="submit act-bar no-print">
        {isLast ? (
          next
        ) : (
          <Button primary onClick={() => setBeat(beat + 1)}>
            Next: another path
          </Button>
        )}
      </div>
    </>
  );
  const heading = (
    <div class={`verdict ${beat === 0 ? word : 'none'}`} key={`title ${beat}`}>
      {beat === 0 && guess.mine && <Mark verdict={word} />}
      <Title isQuiet={isStill}>{pair.title}</Title>
    </div>
  );
  return (
    <>
      {heading}
      {shown.runs ? (
        <RunsView key={beat} board={board} legend={legend} shown={shown.runs} isStill={isStill} isOpen reason={reason} below={<Outcomes {...context} shown={shown} pair={pair} />}>
          {goOn}
        </RunsView>
      ) : (
        <Compare
          key={beat}
          board={board}
          legend={legend}
          robot={shown}
          other={pair.other}
          otherName={pair.isMine ? t('ledger.you') : 'Other'}
          otherLine={pair.isMine ? t('feedback.mine') : 'Another path'}
          at={pair.at}
          isStill={isStill}
          isYours={pair.isMine}
          reason={reason}
        >
          {goOn}
        </Compare>
      )}
    </>
  );
}

// Both halves of "it would rather take 2 more steps than cross rubble: crossing rubble costs more than 2 steps". Of a
// test that somebody answered who must have known it, what it was about.
function Reason({ reason, shown, word, isAsGood }: { reason: string; shown: Demonstration | Test; word: 'right' | 'wrong' | 'none'; isAsGood: boolean }): JSX.Element {
  const [first = '', second = ''] = reason.split(': ');
  const about = isExample(shown) || first !== '' || word !== 'right' || !shown.is_shortest_wrong ? [] : textsOf(shown.covers);
  return (
    <div class="reasons">
      {isAsGood && <p>{t('feedback.right_other')}</p>}
      {first !== '' && <p class="cost">{sentence(first)}</p>}
      {second !== '' && <p>{sentence(second)}</p>}
      {about.length > 0 && <p>{t('feedback.showed')}</p>}
      {about.length > 0 && (
        <ul>
          {about.map((text) => (
            <li>{sentence(text)}</li>
          ))}
        </ul>
      )}
    </div>
  );
}

// Sentences that can be said, each once: of some constraints nothing short is true.
const textsOf = (sentences: Sentence[]): string[] => [...new Set(sentences.map(({ text }) => text))].filter((text) => text !== '');

// What can follow from the robot's action where two paths part, and from the other one.
function Outcomes({ shown, pair: { other, at, isMine }, domain, legend, worlds }: Context & { shown: Demonstration | Test; pair: Pair }): JSX.Element | null {
  const world = worlds.world(shown.world);
  if (!world || !other || at === null) return null;
  const [own, theirs] = [world.actionOf(shown.frames[at]), world.actionOf(other.frames[at])];
  return (
    <Fan board={playBoard(domain, shown)} legend={legend} world={world} state={stateAt(world, shown.state, shown.frames, at)} own={own} other={theirs} isYours={isMine} costs={worlds.costs()} />
  );
}

interface WholeProps extends Context {
  board: Board & { runs?: Runs | null };
  other?: Path | null;
  otherKind?: PathKind;
  at?: number | null;
}

export function Whole({ board, domain, legend, other, otherKind = 'other', at = null }: WholeProps): JSX.Element {
  return <SmallBoard board={playBoard(domain, board)} legend={legend} path={board} runs={board.runs?.runs} other={other ?? null} otherKind={otherKind} at={at} />;
}
